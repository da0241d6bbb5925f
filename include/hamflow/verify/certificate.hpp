// **Certificate**: what a run, or a method, was seen to keep: the class of its energy drift, its momentum maps, and how
// far it comes back when time is reversed.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/verify/drift.hpp"

namespace hamflow {

/// What the observer of a run keeps: the energies at the samples taken, one in each block, and the next one due.
struct EnergyBlockState {
  std::int64_t block_steps = 1;
  std::int64_t next = 0;           // the step of the next sample
  std::vector<double> energies;    // in the order of the blocks
  std::vector<double> magnitudes;  // the largest yet of |q|_max, |p|_max, sum |p_i|, sum_ij |q_i p_j| over the samples

  template <class Archive>
  void archive(Archive& ar) {
    ar(block_steps, next, energies, magnitudes);
  }
};

/// Watches the energy once in each of 128 to 256 blocks of equal length, for runs of any length and in constant memory:
/// when there are too many blocks, two become one. Within its block the place of a sample is random (but always the
/// same): blocks that are all but a whole number of periods long would make a drift of an oscillation.
class EnergyBlocks final : public Observer {
 public:
  static constexpr std::size_t most_blocks = 256;

  EnergyBlocks() { state_.magnitudes.assign(4, 0); }
  std::int64_t next_due(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;

  RunDrift drift() const { return classify_run(state_.energies); }
  const EnergyBlockState& state() const { return state_; }
  void archive(Writer& ar) override { ar(state_); }
  void archive(Reader& ar) override { ar(state_); }

 private:
  EnergyBlockState state_;
};

/// One invariant over a run.
struct MomentumMap {
  std::string name;
  double max_error = 0;
  double relative = 0;               // to the size of its terms
  std::optional<double> rounding{};  // the largest error that rounding explains; none where that is not known
  std::optional<bool> conserved() const {
    return rounding ? std::optional<bool>(max_error <= *rounding) : std::nullopt;
  }
};

/// Forward, momenta negated, forward again, negated: what came back.
struct Reversal {
  std::int64_t steps = 0;  // each way
  Outcome outcome = Outcome::done;
  std::string failure;  // why a step was not taken
  Frame start, turn, end;
  double distance = 0;           // |end - start|, largest coordinate
  double relative_distance = 0;  // to the largest coordinate of the start
  bool bit_exact = false;
  std::uint64_t start_hash = 0, turn_hash = 0, end_hash = 0;  // of the stored bits
};

/// @param pulse called between blocks with the steps taken both ways; returns false to stop
Reversal reverse(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t step)>& pulse = {});

/// The same from the start of a request, on a simulation of its own; none when a step fails.
std::optional<Reversal> reversal_of(const Request& request, std::int64_t steps);

/// The invariants of a run beside what rounding explains.
/// Each is judged by the terms that the problem declares of it (InvariantInfo::terms).
/// @param magnitudes see EnergyBlockState   @param request for its parameters and the units of a lattice
std::vector<MomentumMap> momentum_maps(const Simulation& simulation, const ProblemEntry& problem,
                                       const std::vector<double>& magnitudes, const Request& request);

/// What is reported of a run.
struct RunCertificate {
  RunDrift drift;
  double energy_level = 0;  // max |H - H0|/scale over every step
  std::vector<MomentumMap> momentum_maps;
  std::optional<Reversal> reversal;  // none: it could not be measured
};

/// @param steps_taken of which the reversal takes a small part over again, on a simulation of its own
RunCertificate certify(const Request& request, const ProblemEntry& problem, const Simulation& simulation,
                       const EnergyBlocks& blocks, std::int64_t steps_taken);

}  // namespace hamflow
