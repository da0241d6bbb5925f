#include <algorithm>
#include <cmath>

#include "hamflow/core/math.hpp"
#include "hamflow/verify/measure.hpp"

namespace hamflow {

namespace {
using Long = long double;
constexpr Long epsilon = std::numeric_limits<Long>::epsilon();

Long distance(const State<Long>& a, const State<Long>& b) {
  Long largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = larger(largest, Long(abs(a[i] - b[i])));
  return largest;
}

/// The norm of the derivative of the exact flow: how an early rounding shows at the end.
Long amplification(const StepMap& map, const State<Long>& z, const State<Long>& end, Long time) {
  const Long small = 0x1p-20L;
  Long sum = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    State<Long> near = z;
    near[i] += small;
    sum += distance(map.flow(near, time), end) / small;
  }
  return sum;
}
}  // namespace

Finding OrderMeasurement::is(int order) const {
  if (std::isinf(slope)) return Finding::unclear;
  if (points < fewest_points) return Finding::unclear;
  return std::abs(slope - order) < tolerance ? Finding::yes : Finding::no;
}

OrderMeasurement measure_order(const StepMap& map, const Region& region) {
  const State<Long> start(region.centre.begin(), region.centre.end());
  const Long time = region.time;
  const State<Long> exact = map.flow(start, time);
  const Long size = distance(exact, State<Long>(exact.size()));
  const Long unit = epsilon * size * amplification(map, start, exact, time);

  // From about half a time unit to 2^12 times finer: a coefficient that is wrong in the 6th place has taken over from
  // an error term of order 4 at the fine end. Rounding of N steps is a walk of sqrt(N) units, to which the reference
  // adds a few; points within a factor of 8 of that are masked.
  constexpr int halvings = 12;
  std::vector<double> log_step;
  std::vector<double> log_error;
  bool masked = false;
  std::int64_t steps = static_cast<std::int64_t>(std::ceil(region.time / (4 * region.step)));
  for (int k = 0; k <= halvings && !masked; ++k, steps *= 2) {
    State<Long> z = start;
    const Long h = time / static_cast<Long>(steps);
    if (!map.advance(z, h, steps)) continue;
    const Long error = distance(z, exact);
    if (!(error < size)) continue;  // broken down, or not even a digit
    masked = error < 8 * unit * (8 + sqrt(static_cast<Long>(steps)));
    if (masked) break;
    log_step.push_back(std::log2(static_cast<double>(h)));
    log_error.push_back(static_cast<double>(std::log2(error)));
  }
  OrderMeasurement found;
  if (masked && log_step.empty()) {
    found.slope = std::numeric_limits<double>::infinity();
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
  return found;
}

}  // namespace hamflow
