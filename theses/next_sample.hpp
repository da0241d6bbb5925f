// The range in which the next sample is expected after a few samples.
#pragma once

#include <cmath>
#include <limits>

namespace hamflow::reproduction {

/// Returns k such that the next sample is within k standard deviations of the mean of n samples in 19 of 20 cases:
/// Student's quantile times sqrt(1 + 1/n). It is infinite for a single sample.
inline double range_of_next(int n) {
  if (n < 2) return std::numeric_limits<double>::infinity();
  // Student's quantiles for n - 1 = 1, 2, ...
  constexpr double of_few[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};
  const int freedom = n - 1;
  // For more than ten degrees of freedom, the first terms of the expansion of Cornish and Fisher around the normal
  // quantile z are correct to 0.1 %.
  constexpr double z = 1.959964;
  const double many =
      z + (z * z * z + z) / (4 * freedom) + (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96.0 * freedom * freedom);
  return (freedom <= 10 ? of_few[freedom - 1] : many) * std::sqrt(1 + 1.0 / n);
}

}  // namespace hamflow::reproduction
