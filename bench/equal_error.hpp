// Work at equal error: for each method, the smallest number of equal steps whose end state on a course (a trajectory of
// fixed length) has an error below a target, and the time that they take.
#pragma once

#include "timing.hpp"

namespace bench {

/// A method that runs a course.
struct TimedMethod {
  std::string name;
  int order = 0;
  /// Runs the course `laps` times with `steps` steps each. A Lap has the time of all, and the error of the first.
  struct CourseTiming {
    double nanoseconds = 0;
    double error = 0;
    double forces = 0;
  };
  std::function<CourseTiming(std::int64_t steps, std::int64_t laps)> run;
};

struct Course {
  std::string name;
  std::vector<TimedMethod> racers;  // ratios divide by the first one
  std::int64_t first_steps = 400;
  std::int64_t most_steps = 200'000'000;
};
/// One period of the ellipse e = 0.6.
Course ellipse();
/// Sun, Jupiter to Pluto over 60 000 days, by name.
Course outer_planets();

struct Placed {
  std::string name;
  std::int64_t steps = 0;
  double error = 0;  // the error with these steps
  double forces_per_step = 0;
  Spread us;
  Spread ratio;  // to the time of the first, taken within each round
};

struct EqualErrorComparison {
  std::string course;
  double target = 0;
  std::vector<Placed> placed;
};

/// Races for errors of 1e-6, 1e-9 and 1e-12. A method that needs more than the maximum number of steps is left out.
std::vector<EqualErrorComparison> race(const Plan& plan, const Course& course);

}  // namespace bench
