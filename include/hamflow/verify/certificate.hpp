// **Certificate** of a run or a method: the class of the energy drift, the conservation of momentum maps, and the
// distance after a time reversal.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hamflow/detail/verify/drift.hpp"
#include "hamflow/detail/verify/state_units.hpp"
#include "hamflow/detail/verify/swings.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/verify/long_number.hpp"

namespace hamflow {

/// The energy that the motion exchanges between T = H(q, p) - H(q, 0) and V = H(q, 0), at the samples of a run. It does
/// not depend on a constant in V. If only one part grows, as in a run that blows up, this is not an exchange.
struct EnergyExchange {
  std::int64_t samples = 0;
  double first_kinetic = 0;
  double first_potential = 0;
  double sum_of_kinetic = 0;
  double sum_of_change = 0;

  void look(double kinetic, double potential);
  /// T at the start, or the mean exchange if that is larger. Close encounters and blow-ups have little influence.
  /// nullopt: unknown.
  std::optional<double> typical() const;
  template <class Archive>
  void archive(Archive& ar) {
    ar(samples, first_kinetic, first_potential, sum_of_kinetic, sum_of_change);
  }
};

/// The state of EnergyBlocks: the energies at the samples, one in each block, and the next sample.
struct EnergyBlockState {
  std::int64_t block_steps = 1;
  std::int64_t next = 0;            // the step of the next sample
  std::vector<double> energies;     // in the order of the blocks
  std::vector<std::string> digits;  // the same with all digits, in arithmetic with more digits than double; else empty
  std::vector<double> magnitudes;   // the largest over the samples; see observe()
  std::vector<Swings> swings;       // of each q, then of each p
  EnergyExchange exchange{};

  template <class Archive>
  void archive(Archive& ar) {
    ar(block_steps, next, energies, digits, magnitudes, swings, exchange);
  }
};

/// Samples the energy once in each of 128 to 256 blocks of equal length, for runs of any length in constant memory: if
/// there are too many blocks, two are joined. The place of a sample in its block is random (but always the same),
/// because with blocks of nearly a whole number of periods an oscillation would look like a drift. The turns of q and p
/// are counted at every sample, so oscillations that are too fast for the final blocks are seen at the beginning.
class EnergyBlocks final : public Observer {
 public:
  static constexpr std::size_t most_blocks = 256;

  /// H(q, p), evaluated twice for each sample; empty if the exchanged energy is not needed.
  using Energy = std::function<double(const std::vector<double>& q, const std::vector<double>& p)>;

  explicit EnergyBlocks(Energy energy = {}) : energy_(std::move(energy)) { state_.magnitudes.assign(5, 0); }
  std::int64_t next_due(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;

  const EnergyBlockState& state() const { return state_; }
  void archive(Writer& ar) override { ar(state_); }
  void archive(Reader& ar) override { ar(state_); }

 private:
  Energy energy_;
  EnergyBlockState state_;
};

/// H of a problem for EnergyBlocks; empty for large systems, whose energy takes long, and if H depends on t.
EnergyBlocks::Energy energy_for_blocks(const Request& request, const ProblemEntry& problem, std::size_t coordinates);

/// The largest error of an invariant, as a text if it is below the range of double.
LongNumber largest_error(const InvariantExcursion& seen);

/// One invariant over a run.
struct MomentumMap {
  std::string name;
  LongNumber max_error;
  LongNumber relative;                   // max_error/size of its terms
  std::optional<LongNumber> rounding{};  // the largest error that rounding explains; none: not known
  LongNumber doubtful{};                 // between `rounding` and this the cause of the error is undecided
  /// nullopt: not known or undecided.
  std::optional<bool> conserved() const {
    if (rounding && at_most(max_error, *rounding)) return true;
    return rounding && !at_most(max_error, doubtful) ? std::optional<bool>(false) : std::nullopt;
  }
};

/// The result of a reversal: forward, momenta negated, forward again, momenta negated.
struct Reversal {
  std::int64_t steps = 0;  // each way
  Outcome outcome = Outcome::done;
  std::string failure;  // why a step failed
  Frame start, turn, end;
  std::vector<GroupDistance> distances;  // |end - start| of each group of numbers with one unit
  LongNumber distance;                   // of the group with the largest relative distance
  LongNumber relative_distance;          // distance/size of this group along the motion
  StateSizes sizes;                      // along the way forward
  bool bit_exact = false;
  std::uint64_t start_hash = 0, turn_hash = 0, end_hash = 0;  // of the stored bits
};

/// @param pulse called between blocks with the steps taken forward and back; returns false to stop
/// @param there observers of the way forward   @param groups of the problem (unit_groups); default: q and p
Reversal reverse(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t step)>& pulse = {},
                 std::span<Observer* const> there = {}, const UnitGroups& groups = {});

/// Whether H depends on t. Then the time keeps running on the way back, and negating the momenta does not reverse the
/// motion.
bool depends_on_time(const ProblemEntry& problem);

/// Parity of H in the momenta. If H is not even in them, negating the momenta does not reverse the motion itself.
struct MomentumParity {
  bool is_even = true;          // H(q, -p) = H(q, p) to rounding
  bool to_the_last_bit = true;  // the velocities are exactly odd, as an exact return on the lattice needs
  bool is_defined = true;       // H has a value at (q, -p)
};
/// Evaluated at states of the motion and at others near them in general position, because the terms that make the
/// difference may vanish on the motion itself (the angular momentum in a rotating frame).
/// @param sizes along the motion
MomentumParity parity_in_momenta(const ProblemEntry& problem, const Texts& parameters, const StateSizes& sizes,
                                 std::span<const Frame* const> states);
/// Why a reversal says nothing about the method; empty if H is even in p.
std::string why_not_reversed(const MomentumParity& parity);

/// |q dH/dq| and |p dH/dp|. For homogeneous T and V they are about as large as V and T without constants.
struct Virial {
  double of_q = 0;
  double of_p = 0;
};
/// @param parameters complete
Virial virial(const ProblemEntry& problem, const Texts& parameters, const std::vector<double>& q,
              const std::vector<double>& p);

/// The conclusion from a reversal over a part of a run.
enum class ReversalProof { every_bit, to_rounding, not_reversible, nothing };

constexpr std::string_view name(ReversalProof proof) {
  switch (proof) {
    case ReversalProof::every_bit:
      return "every bit";
    case ReversalProof::to_rounding:
      return "reversible to rounding";
    case ReversalProof::not_reversible:
      return "not reversible";
    case ReversalProof::nothing:
      break;
  }
  return "nothing";
}

struct ReversalEvidence {
  std::int64_t steps = 0;  // each way; 0: not tried
  double share = 0;        // fraction of the run
  std::int64_t bounces = 0;
  std::optional<LongNumber> distance, relative;  // see Reversal; none: a step failed, or H depends on t
  bool bit_exact = false;
  ReversalProof proves = ReversalProof::nothing;
  std::string reason;  // for the conclusion; also says which part of the run was left out
  bool was_stopped = false;
};

/// Called from time to time; returns false if the remaining work is to be left out.
using GoOn = std::function<bool()>;

/// @param period of the slowest oscillation, in steps; nullopt: none was seen   @param steps_taken at least 1
ReversalEvidence reversal_evidence(const Request& request, const ProblemEntry& problem, std::int64_t steps_taken,
                                   std::optional<double> period, const GoOn& go_on = {});

/// Compares the errors of invariants with the errors that rounding explains.
/// Each is judged by the terms that the problem declares for it (InvariantInfo::terms).
/// @param magnitudes see EnergyBlockState   @param request gives the parameters and the units of a lattice
std::vector<MomentumMap> momentum_maps(const Simulation& simulation, const ProblemEntry& problem,
                                       const std::vector<double>& magnitudes, const Request& request);

/// The certificate of a run.
struct RunCertificate {
  RunDrift drift;                                   // increments in units of the largest deviation seen
  LongNumber mean_increment, mean_increment_error;  // of the energy, over a block
  LongNumber trend_not_excluded;                    // of the energy over scale, per step
  LongNumber energy_level;                          // max |H - H0|/scale over every step; NaN: H is 0 at the start
  std::optional<double> typically_exchanged{};      // EnergyExchange::typical()
  std::vector<MomentumMap> momentum_maps;
  std::optional<ReversalEvidence> reversal;  // none: no step was taken
};

/// @param simulation of the run; for a large system it is replaced by another one in the same state
/// @param steps_taken the reversal repeats a small part of these steps, on another simulation
/// @param go_on for the reversal; everything else takes no steps
RunCertificate certify(const Request& request, const ProblemEntry& problem, std::unique_ptr<Simulation>& simulation,
                       const EnergyBlocks& blocks, std::int64_t steps_taken, const GoOn& go_on = {});

}  // namespace hamflow
