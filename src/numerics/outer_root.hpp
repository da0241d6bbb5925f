// The outermost zero of a function on the whole line: of a quadratic in closed form, of any other by a scan.
#pragma once

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

#include "hamflow/core/math.hpp"

namespace hamflow {

/// The largest, or the smallest, x with a x^2 + b x + c = 0, by the formula that does not cancel [Higham2002,
/// Sect. 1.8]. Nothing where there is none.
/// @param noise what rounding may have made of c: a parabola that misses 0 by no more touches it
template <class R>
std::optional<R> quadratic_root(const R& a, const R& b, const R& c, const R& noise, bool largest) {
  if (a == R(0)) {
    if (b == R(0)) return std::nullopt;
    return -c / b;
  }
  const R square = b * b - R(4) * a * c;
  if (!(square >= R(0))) {
    if (!(square + R(4) * abs(a) * noise >= R(0))) return std::nullopt;
    return -b / (R(2) * a);
  }
  const R root = sqrt(square);
  if (b == R(0)) return (largest == (a > R(0)) ? root : -root) / (R(2) * a);
  const R sum = b < R(0) ? -b + root : -b - root;  // no cancellation
  if (sum == R(0)) return R(0);
  const R x = sum / (R(2) * a);
  const R y = R(2) * c / sum;
  return (x < y) == largest ? y : x;
}

struct OuterRoot {
  std::optional<double> x{};  // nothing where the search finds none
  bool told = true;  // false: f oscillates, or is 0, as far as it is looked at, and no zero is known to be the last
};

/// A zero of f in double beyond which, on the side of the largest or of the smallest numbers, a search finds none: f is
/// looked at in 0, in 128 points of each power of 2 from 2^-20 to 2^20 and in four of each from 2^-100 to 2^100, of
/// both signs. Where it comes near 0 between them its extremum is looked for, and beside a zero it is looked at on
/// sixteen finer scales. A dip that is narrower than the points are apart is not seen. What is not finite is passed
/// over.
/// @param is_zero whether f is 0 there to rounding; a change of sign where it is not is a pole or a jump
OuterRoot outer_root(const std::function<double(double)>& f, bool largest, const std::function<bool(double)>& is_zero);

/// A zero of f near one that is known in double, in R: by secants, as long as |f| falls.
template <class R>
R refined_root(const std::function<R(const R&)>& f, double near) {
  if constexpr (std::is_same_v<R, double>) {
    return R(near);
  } else {
    R x(near);
    R at_x = f(x);
    R y = x + R(0x1p-45) * (abs(x) + R(0x1p-100));
    R at_y = f(y);
    for (int i = 0; i < 200; ++i) {
      if (abs(at_y) < abs(at_x)) {
        std::swap(x, y);
        std::swap(at_x, at_y);
      }
      if (at_x == R(0) || at_x == at_y) break;  // x is the better one
      const R z = x - at_x * (y - x) / (at_y - at_x);
      const R at_z = f(z);
      if (!(abs(at_z) < abs(at_x))) break;
      y = z;
      at_y = at_z;
    }
    return x;
  }
}

}  // namespace hamflow
