#include "equal_error.hpp"

#include <algorithm>
#include <cmath>

namespace bench {

namespace {

// A course that takes longer than this (microseconds) is timed only in the first `rounds_of_long_courses` rounds.
constexpr double long_course = 2e5;
constexpr int rounds_of_long_courses = 3;

std::int64_t even(double steps) { return 2 * static_cast<std::int64_t>(std::ceil(steps / 2)); }

/// Finds the smallest even number of steps that reaches the target, to 1 %. A bracket comes from error ~ steps^-order,
/// which holds for small errors; bisection follows. It returns 0 steps if rounding errors exceed the target.
Placed place(const TimedMethod& racer, double target, const Course& course) {
  std::int64_t steps = course.first_steps;
  Placed placed{racer.name, 0, 0, 0, {}, {}};
  std::int64_t too_few = 0;
  for (int attempt = 0; attempt < 60; ++attempt) {
    const TimedMethod::CourseTiming lap = racer.run(steps, 1);
    if (lap.error <= target) {
      placed.steps = steps;
      placed.error = lap.error;
      placed.forces_per_step = lap.forces / static_cast<double>(steps);
    } else {
      too_few = steps;
    }
    const bool enclosed = placed.steps > 0 && too_few > 0;
    const std::int64_t least = std::max<std::int64_t>(2, placed.steps / 100);
    if (enclosed && placed.steps - too_few <= least) break;
    if (enclosed) {
      const double factor = std::pow(lap.error / target, 1.0 / racer.order) * 1.002;
      const std::int64_t next = even(static_cast<double>(steps) * factor);
      const bool inside = next > too_few && next < placed.steps && attempt < 20;
      steps = inside ? next : even(static_cast<double>(too_few + placed.steps) / 2);
      if (steps >= placed.steps) steps = placed.steps - 2;
    } else {
      const double factor = std::clamp(std::pow(lap.error / target, 1.0 / racer.order), 0.25, 4.0);
      steps = placed.steps > 0 ? std::min(steps - 2, even(static_cast<double>(steps) * factor))
                               : std::max(steps + 2, even(static_cast<double>(steps) * factor * 1.01));
      if (steps < 2 || (placed.steps == 0 && steps > course.most_steps)) break;
    }
  }
  return placed;
}

}  // namespace

std::vector<EqualErrorComparison> race(const Plan& plan, const Course& course) {
  std::vector<EqualErrorComparison> races;
  for (const double target : {1e-6, 1e-9, 1e-12}) {
    EqualErrorComparison race{course.name, target, {}};
    std::vector<TimedMethod> all;
    for (const TimedMethod& racer : course.racers) {
      if (racer.order < 4 && target < 1e-9) continue;  // they would need 10^8 steps
      const Placed placed = place(racer, target, course);
      if (placed.steps == 0) continue;
      race.placed.push_back(placed);
      all.push_back(racer);
    }
    // A block has complete courses, because the number of Newton iterations varies along an orbit.
    std::vector<std::vector<double>> times(all.size());
    std::vector<std::int64_t> laps(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double once = all[i].run(race.placed[i].steps, 1).nanoseconds;
      laps[i] = 1 + static_cast<std::int64_t>(plan.block_nanoseconds / 3 / once);
    }
    for (int round = 0; round < plan.rounds; ++round) {
      for (std::size_t i = 0; i < all.size(); ++i) {
        const std::size_t at = (i + static_cast<std::size_t>(round)) % all.size();
        if (round >= rounds_of_long_courses && times[at].front() > long_course) continue;
        const auto lap = all[at].run(race.placed[at].steps, laps[at]);
        times[at].push_back(lap.nanoseconds / 1000 / static_cast<double>(laps[at]));
      }
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      race.placed[i].us = spread_of(times[i]);
      std::vector<double> ratios(times[i].size());
      for (std::size_t r = 0; r < ratios.size(); ++r) ratios[r] = times[i][r] / times[0][r];
      race.placed[i].ratio = spread_of(ratios);
    }
    races.push_back(race);
  }
  return races;
}

}  // namespace bench
