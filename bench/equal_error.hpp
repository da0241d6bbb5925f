// What a given accuracy costs: for each method the fewest steps of one length with which one period of a Kepler ellipse
// ends within the target of where it began, and the time of that period.
#pragma once

#include "timing.hpp"

namespace bench {

struct Placed {
  std::string name;
  std::int64_t steps = 0;  // in a period
  double error = 0;        // |q(T) - q(0)| with them
  Spread us_per_period;
  Spread ratio;  // to the first, within the rounds
};

struct Race {
  double target = 0;
  std::vector<Placed> placed;
};

std::vector<Race> race(const Plan& plan);

}  // namespace bench
