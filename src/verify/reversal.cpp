// Forward, negate the momenta, forward, negate: the experiment that finds every step that is not reversible.
#include <algorithm>
#include <cmath>

#include "hamflow/core/hash.hpp"
#include "hamflow/verify/certificate.hpp"

namespace hamflow {

namespace {
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}
double largest_entry(const std::vector<double>& a) { return largest_difference(a, std::vector<double>(a.size())); }
}  // namespace

Reversal reverse(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t)>& pulse,
                 std::span<Observer* const> there_observers) {
  Reversal found;
  found.steps = steps;
  simulation.look(found.start);
  const std::vector<std::byte> bits = simulation.bits();
  found.start_hash = fnv1a(bits);
  const std::int64_t first = simulation.step();
  const auto counted = [&](std::int64_t step) { return !pulse || pulse(step - first); };
  const auto go = [&](std::int64_t to, std::span<Observer* const> observers) {
    found.outcome = run(simulation, to, observers, counted);
    if (is_failure(found.outcome) && found.outcome != Outcome::non_finite) found.failure = simulation.failure();
    return found.outcome == Outcome::done;
  };
  const bool there = go(first + steps, there_observers);
  simulation.look(found.turn);
  found.turn_hash = fnv1a(simulation.bits());
  if (!there) return found;
  simulation.negate_momenta();
  const bool back = go(first + 2 * steps, {});
  simulation.negate_momenta();
  simulation.look(found.end);
  found.end_hash = fnv1a(simulation.bits());
  if (!back) return found;
  const FrameDigits& to = found.end.digits;
  const FrameDigits& from = found.start.digits;
  if (from.q.empty()) {
    found.distance =
        std::max(largest_difference(found.end.q, found.start.q), largest_difference(found.end.p, found.start.p));
  } else {
    const LongNumber in_q = hamflow::largest_difference(to.q, from.q);
    const LongNumber in_p = hamflow::largest_difference(to.p, from.p);
    found.distance = at_most(in_q, in_p) ? in_p : in_q;
  }
  const double size = std::max(largest_entry(found.start.q), largest_entry(found.start.p));
  found.relative_distance = size > 0 ? quotient(found.distance, size) : found.distance;
  found.bit_exact = simulation.bits() == bits;
  return found;
}

}  // namespace hamflow
