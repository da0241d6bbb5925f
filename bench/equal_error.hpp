// What a given accuracy costs: for each method the fewest steps of one length with which a course of fixed length ends
// within the target of where the motion ends, and the time of that.
#pragma once

#include "timing.hpp"

namespace bench {

/// A method on a course.
struct Racer {
  std::string name;
  int order = 0;
  /// The course so many times, each in so many steps. @return the time of all; `error` of the first
  struct Lap {
    double nanoseconds = 0;
    double error = 0;
    double forces = 0;
  };
  std::function<Lap(std::int64_t steps, std::int64_t laps)> run;
};

struct Course {
  std::string name;
  std::vector<Racer> racers;  // ratios are to the first
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
  double error = 0;  // with them
  double forces_per_step = 0;
  Spread us;
  Spread ratio;  // to the first, within the rounds
};

struct Race {
  std::string course;
  double target = 0;
  std::vector<Placed> placed;
};

/// For errors of 1e-6, 1e-9, 1e-12. Who cannot reach one within the most steps does not take part.
std::vector<Race> race(const Plan& plan, const Course& course);

}  // namespace bench
