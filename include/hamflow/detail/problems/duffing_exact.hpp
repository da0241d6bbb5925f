// x'' = -a x - b x^3 in time, by Jacobi's elliptic functions, for every bounded motion.   [DLMF,
// Sect. 22.13, 22.19(ii)] x'^2 = 2 e - a x^2 - b x^4/2 is quadratic in x^2; its roots are (-a +- S)/b with
//     S^2 = a^2 + 4 b e = w^2 + 2 b v^2,   w = a + b x^2,
// and the form of the motion depends on their signs:
//     b > 0, e >= 0 or a >= 0:  x = A cn(n t + u0),      n^2 = S,           A^2 = (S - a)/b,     m = (S - a)/(2 S),
//     b > 0, e < 0:             x = +-A dn(n t + u0),    n^2 = (S - a)/2,   A^2 = (S - a)/b,     m = 2 S/(S - a),
//     b < 0, inside the well:   x = A sn(n t + u0),      n^2 = (a + S)/2,   A^2 = 4 e/(a + S),   m = (a - S)/(a + S).
// The separatrices e = 0 (b > 0 > a) and S = 0 (b < 0 < a) are m = 1. Every difference is written so that cancellation
// costs at most the effect of a rounding of x, v, a or b.
#pragma once

#include <optional>

#include "hamflow/detail/numerics/elliptic.hpp"
#include "hamflow/detail/problems/linear_oscillator.hpp"

namespace hamflow {

namespace detail {

/// b > 0: every motion is bounded.
inline LinearMotion hardening_motion(long double x, long double v, long double a, long double b, long double t) {
  using Long = long double;
  if (x == 0 && v == 0) return {x, v};
  const Long w = a + b * x * x;
  const Long root = hypot(w, sqrt(2 * b) * v);                              // S
  const Long inside = w > 0 ? 2 * v * v / (root + w) : (root - w) / b;      // A^2 - x^2
  const Long twice_energy = v * v + x * x * (a + b * x * x / 2);            // 2 e
  const Long other = a > 0 ? root + a : 2 * b * twice_energy / (root - a);  // S + a
  const Long square = a > 0 ? 2 * twice_energy / other : (root - a) / b;    // A^2
  if (square == 0 || root == 0) return {x, 0};                              // at rest
  const Long amplitude = sqrt(square);
  // H is even in (x, v): the motion is that of |x|, mirrored.
  const Long side = x < 0 ? -1 : 1;
  const Long sign = side * v > 0 ? -1 : 1;  // sign of sn: an outward motion has not reached the turning point yet
  if (other >= 0) {
    const Long rate = sqrt(root);
    const Long m1 = other / (2 * root);
    const Long u0 = incomplete_f_of_complement(sign * sqrt(inside) / amplitude, side * x / amplitude, m1);
    const Jacobi<Long> j = jacobi_of_complement(rate * t + u0, m1);
    return {side * amplitude * j.cn, -side * amplitude * rate * j.sn * j.dn};
  }
  const Long rate = sqrt((root - a) / 2);
  const Long m = 2 * root / (root - a);
  const Long m1 = -other / (root - a);  // the smaller root over the larger
  const Long sn = sqrt((w > 0 ? 2 * b * v * v / (root + w) : root - w) / (2 * root));
  const Long cn = sqrt((w > 0 ? root + w : 2 * b * v * v / (root - w)) / (2 * root));
  const Jacobi<Long> j = jacobi_of_complement(rate * t + incomplete_f_of_complement(sign * sn, cn, m1), m1);
  return {side * amplitude * j.dn, -side * amplitude * rate * m * j.sn * j.cn};
}

/// b < 0: bounded between the two maxima, which need a > 0, and at rest.
inline std::optional<LinearMotion> softening_motion(long double x, long double v, long double a, long double b,
                                                    long double t) {
  using Long = long double;
  const Long w = a + b * x * x;
  if (v == 0 && (x == 0 || w == 0)) return LinearMotion{x, 0};
  const Long speed = sqrt(-2 * b) * abs(v);
  if (!(w > 0) || speed > w) return std::nullopt;
  const Long root = sqrt((w - speed) * (w + speed));  // S
  const Long twice_energy = v * v + x * x * (a + b * x * x / 2);
  const Long amplitude = sqrt(2 * twice_energy / (a + root));
  const Long rate = sqrt((a + root) / 2);
  const Long m1 = 2 * root / (a + root);
  const Long direction = v < 0 ? -1 : 1;  // H is even in (x, v)
  const Long cn = abs(v) * sqrt(2 / (w + root)) / amplitude;
  const Jacobi<Long> j =
      jacobi_of_complement(rate * t + incomplete_f_of_complement(direction * x / amplitude, cn, m1), m1);
  return LinearMotion{direction * amplitude * j.sn, direction * amplitude * rate * j.cn * j.dn};
}

}  // namespace detail

/// Position and velocity at time t, if the motion is bounded or the equation linear.
inline std::optional<LinearMotion> duffing_motion(long double x, long double v, long double a, long double b,
                                                  long double t) {
  if (b > 0) return detail::hardening_motion(x, v, a, b, t);
  if (b < 0) return detail::softening_motion(x, v, a, b, t);
  return linear_motion(x, v, a, t);
}

}  // namespace hamflow
