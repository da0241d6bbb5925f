#include "step_test_states.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/core/counter_random.hpp"

namespace hamflow {

double size_of(const State<double>& x) {
  double squares = 0;
  for (const double each : x) squares += each * each;
  return std::sqrt(squares);
}

namespace {
double largest_of(const std::vector<double>& xs) {
  double most = 0;
  for (const double x : xs) most = std::max(most, std::abs(x));
  return most;
}

}  // namespace

/// Computes the spectral radius of the vector field's Jacobian as |A^8|^(1/8). Lengths of differences are fractions of
/// the sizes of q and of p, which may have any units.
double frequency_at(const StepProblem& problem, const State<double>& z) {
  const std::size_t n = z.size() / 2;
  const auto field = [&](const State<double>& at) {
    const auto half = at.begin() + static_cast<std::ptrdiff_t>(n);
    const EnergyGradient g = problem.entry->gradient(problem.parameters, {at.begin(), half}, {half, at.end()});
    State<double> f = g.by_p;
    for (const double force : g.by_q) f.push_back(-force);
    return f;
  };
  const auto middle = z.begin() + static_cast<std::ptrdiff_t>(n);
  double size_q = largest_of({z.begin(), middle});
  double size_p = largest_of({middle, z.end()});
  if (!(size_q > 0)) size_q = size_p > 0 ? size_p : 1;
  if (!(size_p > 0)) size_p = size_q;
  const auto unit = [&](std::size_t i) { return i < n ? size_q : size_p; };
  constexpr double d = 0x1p-17;
  const auto times_jacobian = [&](const State<double>& v) {
    State<double> above = z;
    State<double> below = z;
    for (std::size_t i = 0; i < z.size(); ++i) {
      above[i] += d * v[i] * unit(i);
      below[i] -= d * v[i] * unit(i);
    }
    State<double> difference = field(above);
    const State<double> other = field(below);
    for (std::size_t i = 0; i < z.size(); ++i) difference[i] = (difference[i] - other[i]) / (2 * d * unit(i));
    return difference;
  };
  State<double> v;
  for (std::size_t i = 0; i < z.size(); ++i) v.push_back(counter_uniform(state_seed + 2, i));
  double log_growth = 0;
  constexpr int powers = 16;
  for (int k = 0; k < powers; ++k) {
    const double before = size_of(v);
    if (!(before > 0) || !std::isfinite(before)) return 0;
    for (double& x : v) x /= before;
    v = times_jacobian(v);
    if (k >= powers / 2) log_growth += std::log(size_of(v));
  }
  const double found = std::exp(log_growth / (powers / 2));
  return std::isfinite(found) ? found : 0;
}

namespace {
State<double> centre_of(const StepProblem& problem) {
  State<double> z = problem.q;
  z.insert(z.end(), problem.p.begin(), problem.p.end());
  if (!z.empty()) return z;
  const ProblemInfo& info = problem.entry->info;
  const bool is_of_region =
      std::all_of(info.region.parameters.begin(), info.region.parameters.end(), [&](const auto& each) {
        const auto chosen = problem.parameters.find(each.first);
        return chosen != problem.parameters.end() && chosen->second == each.second;
      });
  if (is_of_region && !info.region.centre.empty()) return info.region.centre;
  if (problem.entry->dimension == 0) {
    throw Error(info.name + " has no fixed size; give a state, e.g. by problem.at(q=..., p=...)");
  }
  throw Error(info.name +
              ": found no start; give a state near which the step is measured, e.g. by problem.at(q=..., p=...), since "
              "the motion gives the sizes of q and p and the time scale");
}

}  // namespace

StepTestStates step_test_states(const StepProblem& problem) {
  constexpr double spread = 0.1;
  constexpr std::size_t count = 4;
  const State<double> centre = centre_of(problem);
  const std::size_t n = centre.size() / 2;
  const auto parts = [&](const State<double>& z) {
    const auto half = z.begin() + static_cast<std::ptrdiff_t>(n);
    return std::pair(std::vector<double>(z.begin(), half), std::vector<double>(half, z.end()));
  };
  const auto is_regular = [&](const State<double>& z) {
    const auto [q, p] = parts(z);
    return problem.entry->regular(problem.parameters, q, p);
  };
  if (!is_regular(centre)) {
    throw Error("H or its gradient is not finite at the state chosen for " + problem.entry->info.name +
                "; give a state of the motion, e.g. by problem.at(q=..., p=...)");
  }
  StepTestStates found;
  const auto [q, p] = parts(centre);
  const EnergyGradient g = problem.entry->gradient(problem.parameters, q, p);
  found.frequency = frequency_at(problem, centre);
  // A motion without restoring force, such as free fall, also has a time scale: the time in which it changes the state.
  const double turns_over = std::max(largest_of(q) > 0 ? largest_of(g.by_p) / largest_of(q) : 0,
                                     largest_of(p) > 0 ? largest_of(g.by_q) / largest_of(p) : 0);
  if (found.frequency < 0x1p-10 * turns_over) found.frequency = turns_over;
  const double rate = found.frequency;
  double unit_q = std::max(largest_of(q), rate > 0 ? largest_of(g.by_p) / rate : 0);
  double unit_p = std::max(largest_of(p), rate > 0 ? largest_of(g.by_q) / rate : 0);
  if (!(unit_q > 0)) unit_q = 1;
  if (!(unit_p > 0)) unit_p = 1;
  found.unit.assign(n, unit_q);
  found.unit.resize(2 * n, unit_p);
  for (std::uint64_t draw = 0; found.states.size() < count && draw < 100; ++draw) {
    State<double> z = centre;
    for (std::size_t i = 0; i < z.size(); ++i) {
      z[i] += spread * found.unit[i] * counter_uniform(state_seed + 1, draw * z.size() + i);
    }
    if (is_regular(z)) found.states.push_back(std::move(z));
  }
  for (const auto& z : found.states) found.frequency = std::max(found.frequency, frequency_at(problem, z));
  if (found.states.empty() || !(found.frequency > 0)) {
    throw Error("nothing moves near the state chosen for " + problem.entry->info.name +
                "; give another state, e.g. by problem.at(q=..., p=...)");
  }
  return found;
}

}  // namespace hamflow
