// One linear equation x'' = -lambda x, lambda of either sign or 0, solved exactly in time.
#pragma once

#include "hamflow/core/math.hpp"

namespace hamflow {

struct LinearMotion {
  long double position;
  long double velocity;
};

/// The motion at time t: sines for lambda > 0, hyperbolic sines for lambda < 0, uniform for lambda = 0.
inline LinearMotion linear_motion(long double x, long double v, long double lambda, long double t) {
  const long double w = sqrt(abs(lambda));
  if (w * t == 0) return {x + v * t, v};  // also if the phase underflows
  if (lambda < 0) return {x * cosh(w * t) + v * (sinh(w * t) / w), v * cosh(w * t) + x * (w * sinh(w * t))};
  return {x * cos(w * t) + v * (sin(w * t) / w), v * cos(w * t) - x * (w * sin(w * t))};
}

}  // namespace hamflow
