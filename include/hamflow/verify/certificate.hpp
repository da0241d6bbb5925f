// **Certificate**: what a run, or a method, was seen to keep: the class of its energy drift, its momentum maps, and how
// far it comes back when time is reversed.
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

/// What the motion exchanges between its parts T = H(q, p) - H(q, 0) and V = H(q, 0), at the samples of a run. A
/// constant in V changes nothing of it, and where one part grows alone, as in a run that blows up, that is no exchange.
struct EnergyExchange {
  std::int64_t samples = 0;
  double first_kinetic = 0;
  double first_potential = 0;
  double sum_of_kinetic = 0;
  double sum_of_change = 0;

  void look(double kinetic, double potential);
  /// T at the start, or the mean exchange where that is more: close encounters and blow-ups count for little. None:
  /// nothing is known.
  std::optional<double> typical() const;
  template <class Archive>
  void archive(Archive& ar) {
    ar(samples, first_kinetic, first_potential, sum_of_kinetic, sum_of_change);
  }
};

/// What the observer of a run keeps: the energies at the samples taken, one in each block, and the next one due.
struct EnergyBlockState {
  std::int64_t block_steps = 1;
  std::int64_t next = 0;            // the step of the next sample
  std::vector<double> energies;     // in the order of the blocks
  std::vector<std::string> digits;  // the same with all their digits, in arithmetic beyond double; else empty
  std::vector<double> magnitudes;   // the largest over the samples; see observe()
  std::vector<Swings> swings;       // of each q, then of each p
  EnergyExchange exchange{};

  template <class Archive>
  void archive(Archive& ar) {
    ar(block_steps, next, energies, digits, magnitudes, swings, exchange);
  }
};

/// Watches the energy once in each of 128 to 256 blocks of equal length, for runs of any length and in constant memory:
/// when there are too many blocks, two become one. Within its block the place of a sample is random (but always the
/// same): blocks that are all but a whole number of periods long would make a drift of an oscillation. The turns of q
/// and p are counted at every sample on the way, so that what is too fast for the blocks of the end was seen at first.
class EnergyBlocks final : public Observer {
 public:
  static constexpr std::size_t most_blocks = 256;

  /// H(q, p), which is asked twice a sample; empty where nobody wants to know what is exchanged.
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

/// H of a problem for EnergyBlocks; empty of large systems, whose energy takes long, and where H depends on t.
EnergyBlocks::Energy energy_for_blocks(const Request& request, const ProblemEntry& problem, std::size_t coordinates);

/// How far an invariant was off, as a text where no double is so small.
LongNumber largest_error(const InvariantExcursion& seen);

/// One invariant over a run.
struct MomentumMap {
  std::string name;
  LongNumber max_error;
  LongNumber relative;                   // to the size of its terms
  std::optional<LongNumber> rounding{};  // the largest error that rounding explains; none where that is not known
  LongNumber doubtful{};                 // up to here, beyond that, it may be rounding yet
  /// None: not known, or in doubt.
  std::optional<bool> conserved() const {
    if (rounding && at_most(max_error, *rounding)) return true;
    return rounding && !at_most(max_error, doubtful) ? std::optional<bool>(false) : std::nullopt;
  }
};

/// Forward, momenta negated, forward again, negated: what came back.
struct Reversal {
  std::int64_t steps = 0;  // each way
  Outcome outcome = Outcome::done;
  std::string failure;  // why a step was not taken
  Frame start, turn, end;
  std::vector<GroupDistance> distances;  // |end - start| of each group of numbers with one unit
  LongNumber distance;                   // of the group that is furthest off beside its size along the motion
  LongNumber relative_distance;          // that, over this size
  StateSizes sizes;                      // along the way there
  bool bit_exact = false;
  std::uint64_t start_hash = 0, turn_hash = 0, end_hash = 0;  // of the stored bits
};

/// @param pulse called between blocks with the steps taken both ways; returns false to stop
/// @param there watch the way there   @param groups of the problem (unit_groups); as it is: q is one group, p another
Reversal reverse(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t step)>& pulse = {},
                 std::span<Observer* const> there = {}, const UnitGroups& groups = {});

/// H(q, p, t): on the way back the time goes on, so that negating the momenta does not reverse the motion.
bool depends_on_time(const ProblemEntry& problem);

/// What negating the momenta does to H. Where H is not even in them, the motion itself is not reversed with them.
struct MomentumParity {
  bool is_even = true;          // H(q, -p) = H(q, p) to rounding
  bool to_the_last_bit = true;  // and so are the velocities: what a lattice returns
  bool is_defined = true;       // H has a value at (q, -p)
};
/// Asked at states of the motion and at others beside them, in general position: at those of the motion itself terms
/// may vanish that make the difference (the angular momentum in a rotating frame).
/// @param sizes along the motion
MomentumParity parity_in_momenta(const ProblemEntry& problem, const Texts& parameters, const StateSizes& sizes,
                                 std::span<const Frame* const> states);
/// Why a reversal says nothing about the method; empty where H is even.
std::string why_not_reversed(const MomentumParity& parity);

/// |q dH/dq| + |p dH/dp|: for homogeneous T and V about T and V without their constants.
struct Virial {
  double of_q = 0;
  double of_p = 0;
};
/// @param parameters complete
Virial virial(const ProblemEntry& problem, const Texts& parameters, const std::vector<double>& q,
              const std::vector<double>& p);

/// What a reversal over a part of a run proves.
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
  std::int64_t steps = 0;  // each way; 0: none was tried
  double share = 0;        // of the run
  std::int64_t bounces = 0;
  std::optional<LongNumber> distance, relative;  // see Reversal; none: a step failed, or H depends on t
  bool bit_exact = false;
  ReversalProof proves = ReversalProof::nothing;
  std::string reason;  // also what was left out
  bool was_stopped = false;
};

/// Asked now and then on the way; false: what is not done yet is to be left out.
using GoOn = std::function<bool()>;

/// @param period of the slowest oscillation seen, in steps; none was seen   @param steps_taken at least 1
ReversalEvidence reversal_evidence(const Request& request, const ProblemEntry& problem, std::int64_t steps_taken,
                                   std::optional<double> period, const GoOn& go_on = {});

/// The invariants of a run beside what rounding explains.
/// Each is judged by the terms that the problem declares of it (InvariantInfo::terms).
/// @param magnitudes see EnergyBlockState   @param request for its parameters and the units of a lattice
std::vector<MomentumMap> momentum_maps(const Simulation& simulation, const ProblemEntry& problem,
                                       const std::vector<double>& magnitudes, const Request& request);

/// What is reported of a run.
struct RunCertificate {
  RunDrift drift;                                   // increments in units of the largest deviation seen
  LongNumber mean_increment, mean_increment_error;  // of the energy, over a block
  LongNumber trend_not_excluded;                    // of the energy over scale, per step
  LongNumber energy_level;                          // max |H - H0|/scale over every step; NaN: H is 0 at the start
  std::optional<double> typically_exchanged{};      // EnergyExchange::typical()
  std::vector<MomentumMap> momentum_maps;
  std::optional<ReversalEvidence> reversal;  // none: no step was taken
};

/// @param simulation of the run; that of a large system is another one afterwards, in the same state
/// @param steps_taken of which the reversal takes a small part over again, on a simulation of its own
/// @param go_on of the reversal: all else takes no steps
RunCertificate certify(const Request& request, const ProblemEntry& problem, std::unique_ptr<Simulation>& simulation,
                       const EnergyBlocks& blocks, std::int64_t steps_taken, const GoOn& go_on = {});

}  // namespace hamflow
