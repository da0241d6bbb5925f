// The nearest whole number, halves to even. It is a constant in every derivative, and in a recording it leaves guards:
// the recording holds as long as the whole number is the same.
#pragma once

#include <cstddef>
#include <type_traits>

#include "hamflow/core/dual.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/core/tape.hpp"

namespace hamflow {

template <class R>
R nearest_whole(const R& x) {
  if constexpr (std::is_floating_point_v<R>) {
    return nearbyint(x);
  } else {
    // In several doubles, each the nearest whole number of what is left. Just beyond a half, the double is the half.
    const R half = R(1) / R(2);
    R whole(nearbyint(static_cast<double>(x)));
    for (R rest = x - whole; half < rest || rest < -half; rest = x - whole) {
      const double more = nearbyint(static_cast<double>(rest));
      whole += more != 0 ? R(more) : R(rest < R(0) ? -1 : 1);
    }
    return whole;
  }
}
template <class T, std::size_t N>
base_scalar<T> nearest_whole(const Dual<T, N>& x) {
  return nearest_whole(x.value);
}
template <class R>
R nearest_whole(const Trace<R>& x) {
  const R whole = nearest_whole(x.value);
  const R half = R(1) / R(2);
  const R above = whole + half;
  const R below = whole - half;
  if (x.value < above && below < x.value) {
    (void)(x < Trace<R>(above));
    (void)(Trace<R>(below) < x);
  } else {
    (void)(x == Trace<R>(x.value));  // halfway between two: the recording holds for this very number
  }
  return whole;
}

}  // namespace hamflow
