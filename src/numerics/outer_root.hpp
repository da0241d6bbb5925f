// The outermost zero of a function on the real line: in closed form for a quadratic, by a scan for other functions.
#pragma once

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

#include "hamflow/core/math.hpp"

namespace hamflow {

/// The largest, or the smallest, x with a x^2 + b x + c = 0, by the formula without cancellation [Higham2002, Sect.
/// 1.8]. nullopt if there is none.
/// @param noise possible rounding error of c: a parabola that misses 0 by at most this counts as touching it
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
  std::optional<double> x{};  // nullopt if the search finds none
  bool is_decided =
      true;  // false: f oscillates or is 0 in the whole searched range, and no zero is known to be the last
};

/// The largest or smallest zero of f in double that a search finds. f is evaluated at 0, at 128 points for each power
/// of 2 from 2^-20 to 2^20, and at four points for each from 2^-100 to 2^100, of both signs. If f comes near 0 between
/// points, its extremum is located; near a zero, sixteen finer scales are searched. A dip narrower than the distance of
/// points is not found. Values that are not finite are ignored.
/// @param is_zero whether f is 0 at x to rounding; otherwise a change of sign is a pole or a jump
OuterRoot outer_root(const std::function<double(double)>& f, bool largest, const std::function<bool(double)>& is_zero);

/// Refines a zero of f that is known in double to a zero in R, by the secant method, as long as |f| decreases.
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
