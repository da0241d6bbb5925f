// Lyapunov exponents of a step map: how fast neighbouring orbits of the *method* part.
//
// Tangent vectors are carried by the exact derivative of each step and orthonormalised from time to time, M Q = Q' R;
// the exponents are the sums of log R_ii over time.   [BenettinEtAl1980]
//
// Exponents of a Hamiltonian flow come in pairs +-lambda. Here they do so at every finite time, not in the limit alone:
// the first frame is (u_1 .. u_n, J u_n .. J u_1), orthonormal and symplectic. In this order a symplectic M has a
// factorisation with Q' orthonormal and symplectic and R symplectic, R_ii R_(2n+1-i)(2n+1-i) = 1 (the Iwasawa
// decomposition of the symplectic group), and Q R with R_ii > 0 is unique. A sum lambda_i + lambda_(2n+1-i) that
// differs from 0 by more than rounding therefore shows a step that is not symplectic.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hamflow/detail/run/step_map.hpp"
#include "hamflow/run/observer.hpp"

namespace hamflow {

/// Orthonormal tangent vectors; all 2n, or the first few of them.
class TangentFrame {
 public:
  /// @param dimension n   @param count 1 .. 2n   @param seed of the generic first frame
  TangentFrame(std::size_t dimension, std::size_t count, std::uint64_t seed = 1);
  std::vector<State<double>>& vectors() { return vectors_; }
  const std::vector<State<double>>& vectors() const { return vectors_; }
  /// Makes the vectors orthonormal again, in their order, by modified Gram-Schmidt, twice; `logs` are the log R_ii.
  /// False where one of them vanished or is not finite.
  bool orthonormalise(std::span<double> logs);
  template <class Archive>
  void archive(Archive& ar) {
    ar(vectors_);
  }

 private:
  std::vector<State<double>> vectors_;
};

/// The exponents after a time.
struct LyapunovSpectrum {
  /// In the order of the frame: falling, once they have settled.
  std::vector<double> exponents;
  /// Standard errors of the mean over 32 to 63 blocks of time. Blocks are correlated: the errors are those of blocks of
  /// one, two and four joined, continued to the length of the run by the power with which they fall, and no smaller
  /// than any of these three. NaN before there are 16 blocks. They belong to this stretch of the orbit: where it is
  /// trapped near regular orbits before or later, the exponent of a longer run differs by more.
  std::vector<double> standard_errors;
  /// Whether the largest exponent grew steadily: every two joined blocks have at least a fifth of its mean, and joining
  /// blocks raises its error by less than a half. On regular motion, where the exponents go to 0 like log(t)/t, and on
  /// most sticky orbits it is false: neither value nor error tell what a longer run would show.
  bool steady = false;
  std::vector<double> pair_sums;  // lambda_i + lambda_(2n+1-i), i = 1 .. n, where all 2n are known
  double time = 0;
  std::int64_t renormalisations = 0;
};

/// Sums of log R_ii, with block averages on the way.
class LyapunovSums {
 public:
  explicit LyapunovSums(std::size_t count) : total_(count), block_(count) {}
  void add(std::span<const double> logs, std::int64_t steps);
  /// @param dimension n   @param h the length of a step
  LyapunovSpectrum spectrum(std::size_t dimension, double h) const;
  /// Of exponent i over each so many joined blocks; what is left over at the end is left out.
  std::vector<double> rates(std::size_t i, std::size_t joined, double h) const;
  template <class Archive>
  void archive(Archive& ar) {
    ar(total_, steps_, renormalisations_, block_, block_steps_, wanted_steps_, blocks_);
  }

 private:
  struct Block {
    std::vector<double> logs;
    std::int64_t steps = 0;
    template <class Archive>
    void archive(Archive& ar) {
      ar(logs, steps);
    }
  };
  std::vector<double> total_;
  std::int64_t steps_ = 0;
  std::int64_t renormalisations_ = 0;
  std::vector<double> block_;  // the present one
  std::int64_t block_steps_ = 0;
  std::int64_t wanted_steps_ = 1;  // of a block; doubles when there are too many
  std::vector<Block> blocks_;
};

/// How many steps to take before the next orthonormalisation: their growth should be some powers of 2, which costs
/// about as many bits of the most contracting directions, and stays below 2^20 unless it suddenly triples.
std::int64_t steps_between(std::int64_t present, std::span<const double> logs);

/// Where the map of a step comes from: made when it is first needed, which members in lanes never need.
struct StepMapSource {
  std::size_t dimension = 0;  // n
  std::function<std::shared_ptr<const StepMap>()> map;
};

/// Tangent vectors on the way to the next observation: they depend on nothing that the run does until then.
struct TangentsUnderWay {
  State<double>* z;
  std::vector<State<double>>* vectors;
  std::int64_t steps;
};

/// Follows a run: tangent vectors are carried along its states, which it does not change. Of a run in double.
class TangentWatch : public Observer {
 public:
  /// @param last_step of the run   @throws Error when there is no such map
  TangentWatch(std::shared_ptr<const StepMap> map, double h, std::int64_t last_step);
  TangentWatch(StepMapSource source, double h, std::int64_t last_step);
  std::int64_t next_due(std::int64_t step) const override;
  /// @throws Error when there is no map
  Verdict observe(const Frame& frame) override;
  void archive(Writer& ar) final;
  void archive(Reader& ar) final;
  /// Whether every step could be followed.
  bool followed() const { return followed_; }
  /// The step that the vectors have reached, -1 before the first.
  std::int64_t step() const { return at_; }

  /// What others may carry to the next observation, many watches together; nothing where that is done, or none is due.
  std::optional<TangentsUnderWay> under_way();
  /// They have been carried, state and vectors. Until the observation there is nothing to archive.
  void set_carried() { carried_to_ = next_due(at_ + 1); }

 protected:
  virtual std::vector<State<double>>& tangents() = 0;
  /// Called after so many steps. Returns how many to take next; 0: the vectors cannot be followed any further.
  virtual std::int64_t taken(std::int64_t steps) = 0;
  /// The fields of the class that carries the vectors.
  virtual void archive_tangents(Writer& ar) = 0;
  virtual void archive_tangents(Reader& ar) = 0;
  std::size_t dimension() const { return source_.dimension; }
  double step_length() const { return h_; }

 private:
  bool advance(std::int64_t steps);
  void keep_before_the_end();
  template <class Archive>
  void fields(Archive& ar) {
    ar(due_, at_, z_, followed_);
    archive_tangents(ar);
  }

  StepMapSource source_;
  std::shared_ptr<const StepMap> map_;  // of the source, once it is needed
  double h_;
  std::int64_t last_step_;
  std::int64_t due_ = 0;
  std::int64_t at_ = -1;          // the step to which the vectors belong
  std::int64_t carried_to_ = -1;  // the step to which others have carried them
  State<double> z_;
  bool followed_ = true;
  std::vector<std::byte> before_the_end_;  // what archive() writes after an observation that only the end made due
};

/// Lyapunov exponents beside a run. Costs, for each exponent, about three times the steps behind virtual calls.
class LyapunovWatch final : public TangentWatch {
 public:
  /// @param count of exponents, the largest first; 0: all 2n
  LyapunovWatch(std::shared_ptr<const StepMap> map, double h, std::int64_t last_step, std::size_t count = 0);
  LyapunovWatch(StepMapSource source, double h, std::int64_t last_step, std::size_t count = 0);
  LyapunovSpectrum spectrum() const { return sums_.spectrum(dimension(), step_length()); }
  /// The same where each step is a unit of time.
  LyapunovSpectrum spectrum_by_steps() const { return sums_.spectrum(dimension(), 1); }

 protected:
  std::vector<State<double>>& tangents() override { return frame_.vectors(); }
  std::int64_t taken(std::int64_t steps) override;
  void archive_tangents(Writer& ar) override { ar(frame_, sums_, block_); }
  void archive_tangents(Reader& ar) override { ar(frame_, sums_, block_); }

 private:
  TangentFrame frame_;
  LyapunovSums sums_;
  std::vector<double> logs_;
  std::int64_t block_ = 1;
};

struct LyapunovOptions {
  std::int64_t transient = 0;  // steps before counting begins, in which the vectors turn towards their directions
  std::uint64_t seed = 1;      // of the first frame
};

/// The largest `count` exponents of the orbit of z over `steps` steps after the transient; count 0: all.
/// @throws Error when a step fails
LyapunovSpectrum lyapunov_spectrum(const StepMap& map, State<double> z, double h, std::int64_t steps,
                                   std::size_t count = 0, const LyapunovOptions& options = {});
/// The largest alone; NaN when a step fails. May be called from several threads, also on one map. At its fastest with a
/// StepMapOf that names problem and method as types.
double largest_lyapunov(const StepMap& map, State<double> z, double h, std::int64_t steps,
                        const LyapunovOptions& options = {});

}  // namespace hamflow
