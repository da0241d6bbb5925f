// The root of a monotone function between two points: Newton, guarded by bisection.
#pragma once

#include <limits>

#include "hamflow/core/math.hpp"

namespace hamflow {

/// A value and its derivative.
template <class R>
struct ValueAndSlope {
  R value;
  R slope;
};

/// The x between a and b at which f changes its sign, to rounding of x. f(x) returns {value, slope}; the slope only
/// speeds things up, 0 will do. Positive a and b may differ by large factors: halving is then done on a logarithmic
/// scale.
/// @param positive_at_a the sign of f at a; f is asked neither there nor at b
template <class R, class F>
R bracketed_root(F&& f, R a, R b, bool positive_at_a) {
  const R epsilon = std::numeric_limits<R>::epsilon();
  R x = a + (b - a) / R(2);
  R previous_step = abs(b - a);
  bool polished = false;
  for (int pass = 0; pass < 400; ++pass) {
    const R low = a < b ? a : b;
    const R high = a < b ? b : a;
    if (!(low < x && x < high)) {
      x = low > R(0) && high > R(4) * low ? sqrt(low) * sqrt(high) : low + (high - low) / R(2);
      if (!(low < x && x < high)) return x;
    }
    const ValueAndSlope<R> at = f(x);
    if (at.value == R(0)) return x;
    ((at.value > R(0)) == positive_at_a ? a : b) = x;
    const R step = -at.value / at.slope;
    // Newton has to halve its step; otherwise the bracket is halved.
    if (isfinite(step) && abs(step) <= previous_step / R(2)) {
      previous_step = abs(step);
      x = x + step;
      if (abs(step) <= R(8) * epsilon * abs(x)) {
        if (polished || abs(step) <= epsilon * abs(x) / R(2)) return x < low ? low : (x > high ? high : x);
        polished = true;
      }
    } else {
      if (abs(b - a) <= R(2) * epsilon * abs(x)) return x;
      if (polished) return x;
      previous_step = abs(b - a);
      x = low - R(1);  // out of the bracket: halved above
    }
  }
  return x;
}

}  // namespace hamflow
