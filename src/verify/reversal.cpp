// Forward, negate the momenta, forward, negate: the experiment that finds every step that is not reversible.
#include <algorithm>
#include <cmath>

#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/core/hash.hpp"
#include "hamflow/verify/certificate.hpp"

namespace hamflow {

namespace {
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}
/// The same of numbers with all their digits.
double largest_difference(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::size_t longest = 0;
  for (const std::string& text : a) longest = std::max(longest, text.size());
  const MpDigits scope(static_cast<int>(longest) + 10);
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, static_cast<double>(abs(parse_decimal<Mp>(a[i]) - parse_decimal<Mp>(b[i]))));
  }
  return most;
}
double largest_entry(const std::vector<double>& a) { return largest_difference(a, std::vector<double>(a.size())); }
}  // namespace

Reversal reverse(Simulation& simulation, std::int64_t steps, const std::function<bool(std::int64_t)>& pulse) {
  Reversal found;
  found.steps = steps;
  simulation.look(found.start);
  const std::vector<std::byte> bits = simulation.bits();
  found.start_hash = fnv1a(bits);
  const std::int64_t first = simulation.step();
  const auto counted = [&](std::int64_t step) { return !pulse || pulse(step - first); };
  const auto go = [&](std::int64_t to) {
    found.outcome = run(simulation, to, {}, counted);
    if (found.outcome == Outcome::not_converged) found.failure = simulation.failure();
    return found.outcome == Outcome::done;
  };
  const bool there = go(first + steps);
  simulation.look(found.turn);
  found.turn_hash = fnv1a(simulation.bits());
  if (!there) return found;
  simulation.negate_momenta();
  const bool back = go(first + 2 * steps);
  simulation.negate_momenta();
  simulation.look(found.end);
  found.end_hash = fnv1a(simulation.bits());
  if (!back) return found;
  const FrameDigits& to = found.end.digits;
  const FrameDigits& from = found.start.digits;
  found.distance = from.q.empty() ? std::max(largest_difference(found.end.q, found.start.q),
                                             largest_difference(found.end.p, found.start.p))
                                  : std::max(largest_difference(to.q, from.q), largest_difference(to.p, from.p));
  const double size = std::max(largest_entry(found.start.q), largest_entry(found.start.p));
  found.relative_distance = size > 0 ? found.distance / size : found.distance;
  found.bit_exact = simulation.bits() == bits;
  return found;
}

std::optional<Reversal> reversal_of(const Request& request, std::int64_t steps) {
  Request plain = request;
  plain.watch = false;
  std::unique_ptr<Simulation> simulation;
  try {
    simulation = make_simulation(plain);
  } catch (const Error&) {  // the run itself has all threads that can be started here: one gives the same bits
    plain.threads = 1;
    simulation = make_simulation(plain);
  }
  const Reversal found = reverse(*simulation, steps);
  return found.outcome == Outcome::done ? std::optional<Reversal>(found) : std::nullopt;
}

}  // namespace hamflow
