// **Certificate** of a run or a method: the drift class of the energy error, the conservation of momentum maps, and the
// distance between start and end of a reversal.
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
#include "hamflow/detail/verify/oscillation_counter.hpp"
#include "hamflow/detail/verify/state_units.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/verify/long_number.hpp"

namespace hamflow {

/// Records how much energy a run exchanges between T = H(q, p) - H(q, 0) and V = H(q, 0). The result does not depend on
/// a constant in V. If only one of the two grows, as in a run that blows up, nothing is exchanged.
struct EnergyExchange {
  std::int64_t samples = 0;
  double first_kinetic = 0;
  double first_potential = 0;
  double sum_of_kinetic = 0;
  double sum_of_change = 0;

  void look(double kinetic, double potential);
  /// Returns T at the start, or the mean exchange if that is larger, so that close encounters and blow-ups have little
  /// influence. nullopt: unknown.
  std::optional<double> typical() const;
  template <class Archive>
  void archive(Archive& ar) {
    ar(samples, first_kinetic, first_potential, sum_of_kinetic, sum_of_change);
  }
};

/// State of EnergyBlocks: the energy sampled once in each block, and the step of the next sample.
struct EnergyBlockState {
  std::int64_t block_steps = 1;
  std::int64_t next = 0;         // step of the next sample
  std::vector<double> energies;  // one for each block, in order
  // the same energies with all digits, if the arithmetic has more digits than double; else empty
  std::vector<std::string> digits;
  std::vector<double> magnitudes;          // largest sizes over the samples; observe() lists which
  std::vector<OscillationCounter> swings;  // one for each q, then one for each p
  EnergyExchange exchange{};

  template <class Archive>
  void archive(Archive& ar) {
    ar(block_steps, next, energies, digits, magnitudes, swings, exchange);
  }
};

/// Samples the energy once in each of 128 to 256 blocks of equal length. Memory is constant for runs of any length,
/// because blocks are joined in pairs when there are too many. Each sample is at a pseudo-random place in its block,
/// the same in every run: with equidistant samples, nearly a whole number of periods apart, an oscillation would look
/// like a drift. Turning points of q and p are counted at every sample, so oscillations that are too fast for the final
/// blocks are still seen at the beginning.
class EnergyBlocks final : public Observer {
 public:
  static constexpr std::size_t most_blocks = 256;

  /// H(q, p). It is evaluated twice for each sample. It may be empty if the exchanged energy is not needed.
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

/// Returns H of a problem for EnergyBlocks. The function is empty for large systems, because their energy takes long to
/// evaluate, and if H depends on t.
EnergyBlocks::Energy energy_for_blocks(const Request& request, const ProblemEntry& problem, std::size_t coordinates);

/// Returns the largest error of an invariant, as text if it is below the range of double.
LongNumber largest_error(const InvariantExcursion& seen);

/// Result for one invariant over a run.
struct MomentumMap {
  std::string name;
  LongNumber max_error;
  LongNumber relative;                   // max_error divided by the size of the terms of the invariant
  std::optional<LongNumber> rounding{};  // largest error that rounding explains; nullopt: unknown
  LongNumber doubtful{};                 // errors between `rounding` and this may come from rounding or from the method
  /// nullopt: unknown or undecided.
  std::optional<bool> conserved() const {
    if (rounding && at_most(max_error, *rounding)) return true;
    return rounding && !at_most(max_error, doubtful) ? std::optional<bool>(false) : std::nullopt;
  }
};

/// Result of a reversal: integrate forward, negate the momenta, integrate forward again, negate the momenta.
struct Reversal {
  std::int64_t steps = 0;  // number of steps in each direction
  Outcome outcome = Outcome::done;
  std::string failure;  // why a step failed
  Frame start, turn, end;
  std::vector<GroupDistance> distances;  // |end - start| for each group of numbers with one unit
  LongNumber distance;                   // distance of the group with the largest relative distance
  LongNumber relative_distance;          // distance divided by the size of this group along the motion
  StateSizes sizes;                      // sizes along the first half
  bool bit_exact = false;
  std::uint64_t start_hash = 0, turn_hash = 0, end_hash = 0;  // hashes of the stored bits
};

/// Runs a reversal. @param pulse called between blocks with the number of steps taken, over both halves; returns false
/// to stop
/// @param there observers of the first half   @param groups unit groups of the problem (unit_groups); default: q and p
Reversal reverse(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t step)>& pulse = {},
                 std::span<Observer* const> there = {}, const UnitGroups& groups = {});

/// Returns whether H depends on t. If it does, negating the momenta does not reverse the motion, because the time keeps
/// increasing.
bool depends_on_time(const ProblemEntry& problem);

/// Parity of H in the momenta. If H is not even in the momenta, negating them does not reverse the exact motion either.
struct MomentumParity {
  bool is_even = true;  // H(q, -p) = H(q, p) to rounding
  // the velocities are odd in p bit for bit, which a bit-exact reversal on the lattice needs
  bool to_the_last_bit = true;
  bool is_defined = true;  // H has a value at (q, -p)
};
/// Evaluates H at states of the motion and at nearby states in general position, because terms that are odd in p may
/// vanish on the motion itself (for example the angular momentum in a rotating frame).
/// @param sizes sizes of q and p along the motion
MomentumParity parity_in_momenta(const ProblemEntry& problem, const Texts& parameters, const StateSizes& sizes,
                                 std::span<const Frame* const> states);
/// Returns why a reversal says nothing about the method; empty if H is even in p.
std::string why_not_reversed(const MomentumParity& parity);

/// q dH/dq| and |p dH/dp|. If T and V are homogeneous, they are about as large as V and T, whatever constant V has.
struct VirialTerms {
  double of_q = 0;
  double of_p = 0;
};
/// @param parameters all parameters of the problem
VirialTerms virial(const ProblemEntry& problem, const Texts& parameters, const std::vector<double>& q,
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
  std::int64_t steps = 0;  // number of steps in each direction; 0: there was no reversal
  double share = 0;        // fraction of the run
  std::int64_t bounces = 0;
  std::optional<LongNumber> distance, relative;  // as in Reversal; nullopt: a step failed, or H depends on t
  bool bit_exact = false;
  ReversalProof proves = ReversalProof::nothing;
  std::string reason;  // explains the conclusion, and names the part of the run that was left out
  bool was_stopped = false;
};

/// Called from time to time. Returns false if the remaining work shall be left out.
using ContinueQuestion = std::function<bool()>;

/// Repeats a part of a run and reverses it. @param period period of the slowest oscillation, in steps; nullopt: no
/// oscillation was seen
/// @param steps_taken at least 1
ReversalEvidence reversal_evidence(const Request& request, const ProblemEntry& problem, std::int64_t steps_taken,
                                   std::optional<double> period, const ContinueQuestion& go_on = {});

/// Compares the error of each invariant with the error that rounding explains. The terms that the problem declares for
/// an invariant (InvariantInfo::terms) determine this rounding error.
/// @param magnitudes EnergyBlockState::magnitudes   @param request gives the parameters and the grid spacing of a
/// lattice
std::vector<MomentumMap> momentum_maps(const Simulation& simulation, const ProblemEntry& problem,
                                       const std::vector<double>& magnitudes, const Request& request);

/// Certificate of a run.
struct RunCertificate {
  RunDrift drift;                                   // its increments are in units of the largest deviation seen
  LongNumber mean_increment, mean_increment_error;  // increment of the energy over a block, and its standard error
  // largest drift that is not excluded: energy divided by scale, per step
  LongNumber trend_not_excluded;
  LongNumber energy_level;                      // max |H - H0|/scale over all steps; NaN: H is 0 at the start
  std::optional<double> typically_exchanged{};  // EnergyExchange::typical()
  std::vector<MomentumMap> momentum_maps;
  std::optional<ReversalEvidence> reversal;  // nullopt: no step was taken
};

/// Makes the certificate of a run. @param simulation simulation of the run; for a large system it is replaced by
/// another one in the same state, to save memory
/// @param steps_taken steps of the run; the reversal repeats a small part of them on another simulation
/// @param go_on asked during the reversal; nothing else takes steps
RunCertificate certify(const Request& request, const ProblemEntry& problem, std::unique_ptr<Simulation>& simulation,
                       const EnergyBlocks& blocks, std::int64_t steps_taken, const ContinueQuestion& go_on = {});

}  // namespace hamflow
