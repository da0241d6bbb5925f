// Forward, negate the momenta, forward, negate: the experiment that finds every step that is not reversible.
#include <algorithm>
#include <cmath>
#include <utility>

#include "hamflow/core/hash.hpp"
#include "hamflow/verify/reversal_progress.hpp"

namespace hamflow {

namespace {
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}
double largest_entry(const std::vector<double>& a) { return largest_difference(a, std::vector<double>(a.size())); }

/// All but the states at the start and at the turn, which are the progress's.
/// @param there, back   observers of either way
Reversal carry_out(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t)>& pulse,
                   std::span<Observer* const> there, std::span<Observer* const> back, ReversalProgress& progress) {
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
    const bool arrived = go(first + steps, there);
    simulation.look(progress.turn);
    progress.turn_hash = fnv1a(simulation.bits());
    progress.energy_there = simulation.energy();
    if (arrived) {
      simulation.negate_momenta();
      progress.turned = true;
    }
  }
  found.turn_hash = progress.turn_hash;
  if (!progress.turned) return found;
  if (!go(first + 2 * steps, back)) {
    const auto here = simulation.clone();  // the way back may go on, with what its method remembers
    here->negate_momenta();
    here->look(found.end);
    found.end_hash = fnv1a(here->bits());
    return found;
  }
  simulation.negate_momenta();
  simulation.look(found.end);
  found.end_hash = fnv1a(simulation.bits());
  const FrameDigits& to = found.end.digits;
  const FrameDigits& from = progress.start.digits;
  if (from.q.empty()) {
    found.distance =
        std::max(largest_difference(found.end.q, progress.start.q), largest_difference(found.end.p, progress.start.p));
  } else {
    const LongNumber in_q = hamflow::largest_difference(to.q, from.q);
    const LongNumber in_p = hamflow::largest_difference(to.p, from.p);
    found.distance = at_most(in_q, in_p) ? in_p : in_q;
  }
  const double size = std::max(largest_entry(progress.start.q), largest_entry(progress.start.p));
  found.relative_distance = size > 0 ? quotient(found.distance, size) : found.distance;
  found.bit_exact = simulation.bits() == progress.bits;
  return found;
}

}  // namespace

Reversal reverse(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t)>& pulse,
                 std::span<Observer* const> there) {
  ReversalProgress progress;
  Reversal found = carry_out(simulation, steps, pulse, there, {}, progress);
  found.start = std::move(progress.start);
  found.turn = std::move(progress.turn);
  return found;
}

Reversal reverse(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t)>& pulse,
                 std::span<Observer* const> observers, ReversalProgress& progress) {
  Reversal found = carry_out(simulation, steps, pulse, observers, observers, progress);
  found.start = progress.start;
  found.turn = progress.turn;
  return found;
}

}  // namespace hamflow
