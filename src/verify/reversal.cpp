// Reversal: integrate forward, negate the momenta, integrate forward again, negate them again. It reveals every
// irreversible step.
#include <algorithm>
#include <utility>
#include <vector>

#include "hamflow/core/counter_random.hpp"
#include "hamflow/detail/core/hash.hpp"
#include "reversal_progress.hpp"

namespace hamflow {

namespace {

/// Samples the sizes of the motion during the first half, once in each of about 64 parts, at pseudo-random places that
/// are the same in every run. At places in step with an oscillation the momenta may be 0 each time.
class ForwardSizes final : public Observer {
 public:
  ForwardSizes(std::int64_t first, std::int64_t steps, StateSizes& sizes)
      : first_(first), last_(first + steps), part_(std::max<std::int64_t>(1, steps / 64)), sizes_(sizes) {}
  std::int64_t next_due(std::int64_t step) const override {
    const std::int64_t k = std::max<std::int64_t>(0, step - first_) / part_;
    const std::int64_t due = place(k) >= step ? place(k) : place(k + 1);
    return due > last_ ? never : due;
  }
  Verdict observe(const Frame& frame) override {
    sizes_.include(frame.q, frame.p);
    return Verdict::go_on;
  }

 private:
  std::int64_t place(std::int64_t k) const {
    constexpr std::uint64_t draw = 64;
    const std::uint64_t random = counter_bits(draw, static_cast<std::uint64_t>(k));
    return first_ + k * part_ + static_cast<std::int64_t>(random % static_cast<std::uint64_t>(part_));
  }

  std::int64_t first_, last_, part_;
  StateSizes& sizes_;
};

/// Runs the reversal. `progress` keeps the states at the start and at the turn.
/// @param there, back observers of the first and of the second half
Reversal carry_out(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t)>& pulse,
                   std::span<Observer* const> there, std::span<Observer* const> back, ReversalProgress& progress,
                   const UnitGroups& groups) {
  Reversal found;
  found.steps = steps;
  if (!progress.begun) {
    simulation.look(progress.start);
    progress.bits = simulation.bits();
    progress.start_hash = fnv1a(progress.bits);
    progress.first = simulation.step();
    progress.begun = true;
  }
  found.start_hash = progress.start_hash;
  const std::int64_t first = progress.first;
  const auto counted = [&](std::int64_t step) { return !pulse || pulse(step - first); };
  const auto go = [&](std::int64_t to, std::span<Observer* const> observers) {
    found.outcome = run(simulation, to, observers, counted);
    if (is_failure(found.outcome) && found.outcome != Outcome::non_finite)
      found.failure = cause_of(simulation.failure());
    return found.outcome == Outcome::done;
  };
  if (!progress.turned) {
    ForwardSizes sizes(first, steps, progress.sizes);
    std::vector<Observer*> watching{&sizes};
    watching.insert(watching.end(), there.begin(), there.end());
    const bool arrived = go(first + steps, watching);
    simulation.look(progress.turn);
    progress.turn_hash = fnv1a(simulation.bits());
    progress.forward_energy = simulation.energy();
    if (arrived) {
      simulation.negate_momenta();
      progress.turned = true;
    }
  }
  found.turn_hash = progress.turn_hash;
  progress.sizes.include(progress.start.q, progress.start.p);
  progress.sizes.include(progress.turn.q, progress.turn.p);
  found.sizes = progress.sizes;
  if (!progress.turned) return found;
  if (!go(first + 2 * steps, back)) {
    const auto here = simulation.clone();  // the original may continue the second half with what its method remembers
    here->negate_momenta();
    here->look(found.end);
    found.end_hash = fnv1a(here->bits());
    return found;
  }
  simulation.negate_momenta();
  simulation.look(found.end);
  found.end_hash = fnv1a(simulation.bits());
  found.distances = group_distances(groups, progress.sizes, found.end, progress.start);
  const GroupDistance* furthest = &found.distances.front();
  for (const GroupDistance& each : found.distances) {
    if (!at_most(each.relative, furthest->relative)) furthest = &each;
  }
  found.distance = furthest->distance;
  found.relative_distance = furthest->relative;
  found.bit_exact = simulation.bits() == progress.bits;
  return found;
}

}  // namespace

Reversal reverse(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t)>& pulse,
                 std::span<Observer* const> there, const UnitGroups& groups) {
  ReversalProgress progress;
  Reversal found = carry_out(simulation, steps, pulse, there, {}, progress, groups);
  found.start = std::move(progress.start);
  found.turn = std::move(progress.turn);
  return found;
}

Reversal reverse(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t)>& pulse,
                 std::span<Observer* const> observers, ReversalProgress& progress, const UnitGroups& groups) {
  Reversal found = carry_out(simulation, steps, pulse, observers, observers, progress, groups);
  found.start = progress.start;
  found.turn = progress.turn;
  return found;
}

}  // namespace hamflow
