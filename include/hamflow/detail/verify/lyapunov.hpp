// Lyapunov exponents of a step map: the rates at which neighbouring orbits of the *method* separate.
//
// Tangent vectors are multiplied by the exact derivative of each step and orthonormalised from time to time, M Q = Q'
// R. The exponents are the sums of log R_ii divided by the time.   [BenettinEtAl1980]
//
// Exponents of a Hamiltonian flow come in pairs +-lambda. Here the pairs cancel at every finite time, not only in the
// limit, because the first frame is (u_1 .. u_n, J u_n .. J u_1), orthonormal and symplectic. With vectors in this
// order, a symplectic M factorises into an orthonormal symplectic Q' and a symplectic R with R_ii R_(2n+1-i)(2n+1-i) =
// 1 (the Iwasawa decomposition of the symplectic group), and the factorisation with R_ii > 0 is unique. So a sum
// lambda_i + lambda_(2n+1-i) that differs from 0 by more than rounding proves that a step is not symplectic.
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

/// Orthonormal tangent vectors: all 2n, or the first few of them.
class TangentFrame {
 public:
  /// @param dimension n   @param count number of vectors, 1 .. 2n   @param seed seed of the generic first frame
  TangentFrame(std::size_t dimension, std::size_t count, std::uint64_t seed = 1);
  std::vector<State<double>>& vectors() { return vectors_; }
  const std::vector<State<double>>& vectors() const { return vectors_; }
  /// Makes the vectors orthonormal in their order, by modified Gram-Schmidt applied twice, and writes the log R_ii to
  /// `logs`. Returns false if a vector vanished or is not finite.
  bool orthonormalise(std::span<double> logs);
  template <class Archive>
  void archive(Archive& ar) {
    ar(vectors_);
  }

 private:
  std::vector<State<double>> vectors_;
};

/// The exponents after some time.
struct LyapunovSpectrum {
  /// Exponents in the order of the frame, which is decreasing after they have settled.
  std::vector<double> exponents;
  /// Standard errors of the mean over 32 to 63 blocks of time. Neighbouring blocks are correlated. Therefore the errors
  /// for groups of one, two and four blocks are extrapolated to the length of the run, by the power with which they
  /// decrease; the result is at least as large as each of the three. NaN with fewer than 16 blocks. The errors are
  /// valid for this part of the orbit: if the orbit stays near regular orbits earlier or later, the exponent of a
  /// longer run differs by more.
  std::vector<double> standard_errors;
  /// Whether the largest exponent grew steadily: its rate in every pair of neighbouring blocks is at least a fifth of
  /// its mean, and taking blocks in pairs raises its error by less than a half. It is false for regular motion, where
  /// the exponents decrease to 0 like log(t)/t, and for most sticky orbits. Then value and error do not predict a
  /// longer run.
  bool steady = false;
  std::vector<double> pair_sums;  // lambda_i + lambda_(2n+1-i), i = 1 .. n, if all 2n are known
  double time = 0;
  std::int64_t renormalisations = 0;
};

/// Sums of log R_ii over the run and over blocks.
class LyapunovSums {
 public:
  explicit LyapunovSums(std::size_t count) : total_(count), block_(count) {}
  void add(std::span<const double> logs, std::int64_t steps);
  /// @param dimension n   @param h step size
  LyapunovSpectrum spectrum(std::size_t dimension, double h) const;
  /// Returns the rates of exponent i over each group of `joined` blocks. An incomplete group at the end is left out.
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
  std::vector<double> block_;  // sums over the current block
  std::int64_t block_steps_ = 0;
  std::int64_t wanted_steps_ = 1;  // length of a block in steps; doubles when there are too many blocks
  std::vector<Block> blocks_;
};

/// Returns the number of steps until the next orthonormalisation. Growth between two of them should be a few powers of
/// 2, because the most contracting directions lose about as many bits. It stays below 2^20 unless the rate suddenly
/// triples.
std::int64_t steps_between(std::int64_t present, std::span<const double> logs);

/// Makes the map of a step when it is first needed. Members of a sweep that run in SIMD lanes never need it.
struct StepMapSource {
  std::size_t dimension = 0;  // n
  std::function<std::shared_ptr<const StepMap>()> map;
};

/// State and tangent vectors that the caller advances to the next observation, independently of the run.
struct TangentsToAdvance {
  State<double>* z;
  std::vector<State<double>>* vectors;
  std::int64_t steps;
};

/// Carries tangent vectors along a run in double. It does not change the states of the run.
class TangentObserver : public Observer {
 public:
  /// @param last_step last step of the run   @throws Error if there is no such map
  TangentObserver(std::shared_ptr<const StepMap> map, double h, std::int64_t last_step);
  TangentObserver(StepMapSource source, double h, std::int64_t last_step);
  std::int64_t next_due(std::int64_t step) const override;
  /// @throws Error if there is no map
  Verdict observe(const Frame& frame) override;
  void archive(Writer& ar) final;
  void archive(Reader& ar) final;
  /// Whether every step could be differentiated.
  bool followed() const { return followed_; }
  /// The step that the vectors have reached; -1 before the first observation.
  std::int64_t step() const { return at_; }

  /// Returns the vectors that the caller may advance to the next observation, together with those of other watches.
  /// nullopt if they have been advanced already, or if no observation is due.
  std::optional<TangentsToAdvance> tangents_to_advance();
  /// Call this after state and vectors were advanced. Do not call archive() between this call and the observation.
  void set_advanced() { advanced_to_ = next_due(at_ + 1); }

 protected:
  virtual std::vector<State<double>>& tangents() = 0;
  /// Called after `steps` steps. Returns the number of steps to take next; 0: the vectors cannot be carried any
  /// further.
  virtual std::int64_t taken(std::int64_t steps) = 0;
  /// Archives the fields of the derived class.
  virtual void archive_tangents(Writer& ar) = 0;
  virtual void archive_tangents(Reader& ar) = 0;
  std::size_t dimension() const { return source_.dimension; }
  double step_length() const { return h_; }

 private:
  bool advance(std::int64_t steps);
  void keep_state_before_end();
  template <class Archive>
  void fields(Archive& ar) {
    ar(due_, at_, z_, followed_);
    archive_tangents(ar);
  }

  StepMapSource source_;
  std::shared_ptr<const StepMap> map_;  // made by source_ when it is first needed
  double h_;
  std::int64_t last_step_;
  std::int64_t due_ = 0;
  std::int64_t at_ = -1;           // step to which the vectors belong
  std::int64_t advanced_to_ = -1;  // step to which the caller has advanced them
  State<double> z_;
  bool followed_ = true;
  std::vector<std::byte>
      // state before the last observation; archived if that observation was only due because the run ended
      before_the_end_;
};

/// Lyapunov exponents of a run. Each exponent costs about three times as much as steps behind virtual calls.
class LyapunovObserver final : public TangentObserver {
 public:
  /// @param count number of exponents, the largest first; 0: all 2n
  LyapunovObserver(std::shared_ptr<const StepMap> map, double h, std::int64_t last_step, std::size_t count = 0);
  LyapunovObserver(StepMapSource source, double h, std::int64_t last_step, std::size_t count = 0);
  LyapunovSpectrum spectrum() const { return sums_.spectrum(dimension(), step_length()); }
  /// The same, with one step as the unit of time.
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
  std::int64_t transient = 0;  // steps before the sums begin, so that the vectors can align with their directions
  std::uint64_t seed = 1;      // seed of the first frame
};

/// Returns the largest `count` exponents of the orbit of z over `steps` steps after the transient; count 0: all.
/// @throws Error if a step fails
LyapunovSpectrum lyapunov_spectrum(const StepMap& map, State<double> z, double h, std::int64_t steps,
                                   std::size_t count = 0, const LyapunovOptions& options = {});
/// Returns only the largest exponent; NaN if a step fails. Several threads may call it, also with the same map. It is
/// fastest with a StepMapOf, which knows problem and method as types.
double largest_lyapunov(const StepMap& map, State<double> z, double h, std::int64_t steps,
                        const LyapunovOptions& options = {});

}  // namespace hamflow
