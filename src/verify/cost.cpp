#include <fmt/format.h>

#include "hamflow/verify/measure.hpp"

namespace hamflow {

CostMeasurement measure_cost(const StepMap& map, const Region& region) {
  // Steps 9 to 136 are counted, because the first steps may do more than the later ones.
  constexpr std::int64_t skipped = 8;
  constexpr std::int64_t counted = 128;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const auto completes = [&](double h) { return map.energies(region.centre, h, 1, skipped + counted).size() == 2; };
  const bool done = completes(region.step);
  const Effort before = map.cost(region.centre, region.step, skipped);
  const Effort after = map.cost(region.centre, region.step, skipped + counted);
  const auto per_step = [](long long x, long long y) { return static_cast<double>(y - x) / counted; };
  CostMeasurement found{per_step(before.force, after.force), per_step(before.gradient, after.gradient),
                        per_step(before.hessian, after.hessian), per_step(before.linear_solves, after.linear_solves)};

  bool explicit_step = after.linear_solves == 0 && after.steps == 0;
  if (!done) {  // solves that were counted prove an implicit step, but steps that were not taken prove nothing
    found = {unknown, unknown, unknown, unknown, explicit_step ? Finding::unclear : Finding::no, unknown};
    found.reason = fmt::format("one of the first {} steps failed", skipped + counted);
    return found;
  }
  Effort last = before;
  for (std::int64_t k = 1; k <= 8 && explicit_step; ++k) {
    const Effort now = map.cost(region.centre, region.step, skipped + k);
    explicit_step = static_cast<double>(now.force - last.force) == found.force &&
                    static_cast<double>(now.gradient - last.gradient) == found.gradient;
    last = now;
  }
  found.explicit_step = explicit_step ? Finding::yes : Finding::no;
  const Effort coarse_before = map.cost(region.centre, 4 * region.step, skipped);
  const Effort coarse_after = map.cost(region.centre, 4 * region.step, skipped + counted);
  found.coarse_solves = per_step(coarse_before.linear_solves, coarse_after.linear_solves);
  if (!explicit_step && coarse_after.steps < skipped + counted) {
    found.coarse_solves = unknown;
    found.reason = fmt::format("one of the first {} steps with four times the step size failed", skipped + counted);
  }
  return found;
}

}  // namespace hamflow
