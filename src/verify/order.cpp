#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "hamflow/core/math.hpp"
#include "hamflow/verify/measure.hpp"
#include "measuring_stopped.hpp"

namespace hamflow {

namespace {
template <class Long>
Long distance(const State<Long>& a, const State<Long>& b) {
  Long largest(0);
  for (std::size_t i = 0; i < a.size(); ++i) largest = larger(largest, Long(abs(a[i] - b[i])));
  return largest;
}
double log2_of(long double x) { return static_cast<double>(std::log2(x)); }
double log2_of(const Quad& x) { return static_cast<double>(log(x)) / std::log(2.0); }

/// Returns the norm of the derivative of the exact flow, which amplifies an early rounding until the end.
template <class Long>
Long amplification(const StepMap& map, const State<Long>& z, const State<Long>& end, const Long& time) {
  const Long small(0x1p-20L);
  Long sum(0);
  for (std::size_t i = 0; i < z.size(); ++i) {
    State<Long> near = z;
    near[i] += small;
    sum += distance(map.flow(near, time), end) / small;
  }
  return sum;
}

template <class Long>
OrderMeasurement slope_in(const StepMap& map, const Region& region);
}  // namespace

Finding OrderMeasurement::is(int order) const {
  if (std::isinf(slope)) return Finding::unclear;
  if (points < fewest_points) return Finding::unclear;
  return std::abs(slope - order) < tolerance ? Finding::yes : Finding::no;
}

OrderMeasurement measure_order(const StepMap& map, const Region& region) {
  // In long double, four halvings of the step lead a method of order 8 from half a digit to the rounding level. Methods
  // of order 6 with small error constants do not even have four.
  constexpr int highest_in_long_double = 5;
  const bool in_quad = map.claims().order > highest_in_long_double && map.has_quad();
  return in_quad ? slope_in<Quad>(map, region) : slope_in<long double>(map, region);
}

namespace {
template <class Long>
OrderMeasurement slope_in(const StepMap& map, const Region& region) {
  const State<Long> start = map.settled(State<Long>(region.centre.begin(), region.centre.end()));
  const Long time(region.time);
  const Long long_epsilon = std::numeric_limits<Long>::epsilon();
  const State<Long> exact = map.flow(start, time);
  const Long size = distance(exact, State<Long>(exact.size()));
  const Long unit = long_epsilon * size * amplification(map, start, exact, time);

  // Step sizes go from about half a time unit down to 2^12 times less. At the smallest, a coefficient that is wrong in
  // its 6th digit dominates an error term of order 4. The rounding errors of N steps make a random walk of sqrt(N)
  // units, to which the reference adds a few; errors within a factor of 8 of that are masked.
  // Implicit methods get only 8 halvings in quad: their steps cost hundreds of others, and no single coefficient can be
  // wrong in its 6th digit, because all follow from Gauss points.
  const int halvings = std::is_same_v<Long, Quad> && !map.claims().explicit_step ? 8 : 12;
  std::vector<double> log_step;
  std::vector<double> log_error;
  bool masked = false;
  int tried = 0;
  int failed = 0;
  std::int64_t steps = static_cast<std::int64_t>(std::ceil(region.time / (4 * region.step)));
  for (int k = 0; k <= halvings && !masked; ++k, steps *= 2) {
    throw_if_stopped();
    State<Long> z = start;
    const Long h = time / static_cast<Long>(steps);
    ++tried;
    if (!map.advance(z, h, steps)) {
      ++failed;
      continue;
    }
    const Long error = distance(z, exact);
    if (!(error < size)) continue;  // the run broke down, or the error is as large as the motion
    masked = error < Long(8) * unit * (Long(8) + Long(std::sqrt(static_cast<double>(steps))));
    if (masked) break;
    log_step.push_back(std::log2(static_cast<double>(h)));
    log_error.push_back(log2_of(error));
  }
  OrderMeasurement found;
  if (masked && log_step.empty()) {
    found.slope = std::numeric_limits<double>::infinity();
    found.reason = "all errors are at rounding level, so the method is exact here and the order cannot be measured";
    return found;
  }
  const std::size_t surplus =
      log_step.size() > OrderMeasurement::fewest_points ? log_step.size() - OrderMeasurement::fewest_points : 0;
  log_step.erase(log_step.begin(), log_step.begin() + static_cast<std::ptrdiff_t>(surplus));
  log_error.erase(log_error.begin(), log_error.begin() + static_cast<std::ptrdiff_t>(surplus));
  found.points = static_cast<int>(log_step.size());
  if (found.points >= 2) {
    found.slope = fitted_slope(log_step, log_error);
    found.finest_step = std::exp2(log_step.back());
    found.finest_error = std::exp2(log_error.back());
  }
  if (found.points < OrderMeasurement::fewest_points) {
    found.reason = fmt::format("{} error{} of the {} that a slope needs", found.points, found.points == 1 ? "" : "s",
                               OrderMeasurement::fewest_points);
    if (failed > 0) found.reason += fmt::format(", because a step failed with {} of {} step sizes", failed, tried);
  }
  return found;
}
}  // namespace

}  // namespace hamflow
