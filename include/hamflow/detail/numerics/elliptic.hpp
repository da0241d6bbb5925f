// Elliptic integrals of the first kind and Jacobi's elliptic functions, parameter m = k^2 in [0, 1].
//     F(phi, m) = integral_0^phi dx/sqrt(1 - m sin^2 x),   K(m) = F(pi/2, m),   u = F(am u, m),
//     sn u = sin am u,   cn u = cos am u,   dn u = sqrt(1 - m sn^2 u).                    [DLMF, Sect. 19.2, 22.16]
// Near m = 1 all results depend on 1 - m, whose digits are lost in m; the functions `_of_complement` take m1 = 1 - m
// and keep its digits. They are also accurate near m = 0, where all functions are smooth.
#pragma once

#include <limits>

#include "hamflow/core/number.hpp"

namespace hamflow {

template <class R>
struct Jacobi {
  R sn;
  R cn;
  R dn;
  R am;  // the amplitude, growing by pi in every 2 K
};

namespace detail {

/// The arithmetic-geometric mean of 1 and sqrt(m1), with the steps that led there.   [DLMF, Sect. 19.8(i)]
template <class R>
struct AgmLadder {
  // The logarithm of the ratio is halved in every step until it is about 1, then the convergence is quadratic: from the
  // smallest extended number that takes 14 + 5 steps.
  static constexpr int most_steps = 24;
  R arithmetic[most_steps];
  R geometric[most_steps];
  R mean;
  int steps = 0;

  explicit AgmLadder(R m1) {
    R a(1);
    R b = sqrt(m1);
    for (;;) {
      arithmetic[steps] = a;
      geometric[steps] = b;
      mean = (a + b) / R(2);
      ++steps;
      // The next mean would differ by (a - b)^2/(16 a), less than a rounding.
      if (abs(a - b) <= sqrt(std::numeric_limits<R>::epsilon()) * a || steps == most_steps) return;
      b = sqrt(a * b);
      a = mean;
    }
  }
};

template <class R>
R not_a_number() {
  return std::numeric_limits<R>::quiet_NaN();
}

/// Whether n, a whole number, is odd.
template <class R>
bool is_odd(R n) {
  return R(2) * nearbyint(n / R(2)) != n;
}

/// Carlson's R_F(x, y, z) by duplication, to a few roundings; at most one argument 0.   [DLMF, (19.36.1),
/// Sect. 19.36(i)]
template <class R>
R carlson_rf(R x, R y, R z) {
  const R start_mean = (x + y + z) / R(3);
  const R dx = start_mean - x;
  const R dy = start_mean - y;
  R spread = larger(larger(R(abs(dx)), R(abs(dy))), R(abs(dx + dy)));
  R mean = start_mean;
  R quarter(1);
  // The series below stops at the seventh order. With X, Y, Z < 1/300 the eighth is below 2^-64.
  while (quarter * spread * R(300) > mean) {
    const R lambda = sqrt(x * y) + sqrt(y * z) + sqrt(z * x);
    x = (x + lambda) / R(4);
    y = (y + lambda) / R(4);
    z = (z + lambda) / R(4);
    mean = (mean + lambda) / R(4);
    quarter = quarter / R(4);
  }
  const R cx = dx * quarter / mean;
  const R cy = dy * quarter / mean;
  const R cz = -cx - cy;
  const R e2 = cx * cy - cz * cz;
  const R e3 = cx * cy * cz;
  const R series = -e2 / R(10) + e3 / R(14) + e2 * e2 / R(24) - R(3) * e2 * e3 / R(44) - R(5) * e2 * e2 * e2 / R(208) +
                   R(3) * e3 * e3 / R(104) + e2 * e2 * e3 / R(16);
  return (R(1) + series) / sqrt(mean);
}

}  // namespace detail

/// K from m1 = 1 - m; infinite at m1 = 0.   [DLMF, (19.8.5)]
template <class R>
R complete_k_of_complement(R m1) {
  if (!(m1 >= R(0) && m1 <= R(1))) return detail::not_a_number<R>();
  if (m1 == R(0)) return std::numeric_limits<R>::infinity();
  return pi_value<R>() / (R(2) * detail::AgmLadder<R>(m1).mean);
}

/// K(m).
template <class R>
R complete_k(R m) {
  return complete_k_of_complement(R(1) - m);
}

/// F of the angle in [-pi/2, pi/2] with sine s and cosine c >= 0. Both are arguments, because near m = 1 and a quarter
/// turn F depends on c, which the angle does not determine accurately.   [DLMF, (19.25.5)]
template <class R>
R incomplete_f_of_complement(R s, R c, R m1) {
  if (c == R(0) && m1 == R(0)) return copysign(std::numeric_limits<R>::infinity(), s);
  return s * detail::carlson_rf(R(c * c), R(c * c + m1 * s * s), R(s * s + c * c));
}

/// F(phi, m) for any phi.
template <class R>
R incomplete_f(R phi, R m) {
  const R m1 = R(1) - m;
  if (!(m1 >= R(0) && m1 <= R(1))) return detail::not_a_number<R>();
  R turns = nearbyint(phi / pi_value<R>());
  R s = sin(phi);
  R c = cos(phi);
  if (detail::is_odd(turns)) {
    s = -s;
    c = -c;
  }
  if (c < R(0)) {  // the quotient was rounded across half a turn
    turns += copysign(R(1), s);
    s = -s;
    c = -c;
  }
  const R rest = incomplete_f_of_complement(s, c, m1);
  return turns == R(0) ? rest : R(2) * turns * complete_k(m) + rest;
}

/// sn, cn, dn, am of u from m1 = 1 - m, by Gauss' transformation of the ratio cn/sn along the steps of the mean. Every
/// operation adds or multiplies positive numbers, so that sn, cn and dn keep their relative accuracy; what remains is
/// the rounding of the phase u.   [Bulirsch1965]
template <class R>
Jacobi<R> jacobi_of_complement(R u, R m1) {
  if (!(m1 >= R(0) && m1 <= R(1))) {
    const R nan = detail::not_a_number<R>();
    return {nan, nan, nan, nan};
  }
  if (m1 == R(0)) {
    const R sech = R(1) / cosh(u);
    return {tanh(u), sech, sech, atan(sinh(u))};
  }
  const detail::AgmLadder<R> ladder(m1);
  const R pi = pi_value<R>();
  const R half_periods = nearbyint(ladder.mean * u / pi);  // u - half_periods * 2 K lies in [-K, K]
  const R phi = ladder.mean * u - half_periods * pi;
  const R rest = phi / ladder.mean;
  R sn = rest;
  R cn = R(1) - rest * rest / R(2);
  R dn = R(1) - (R(1) - m1) * rest * rest / R(2);
  if (rest * rest > std::numeric_limits<R>::epsilon()) {
    const R cotangent = abs(cos(phi) / sin(phi));
    R ratio = ladder.mean * cotangent;
    R previous = cotangent;
    dn = R(1);
    for (int n = ladder.steps - 1; n >= 0; --n) {
      const R square = previous * ratio;
      ratio *= dn;
      dn = (ladder.geometric[n] + square) / (ladder.arithmetic[n] + square);
      previous = ratio / ladder.arithmetic[n];
    }
    const R size = R(1) / sqrt(ratio * ratio + R(1));
    sn = copysign(size, phi);
    cn = copysign(ratio * size, R(cos(phi)));
  }
  const R am = half_periods * pi + atan2(sn, cn);
  if (detail::is_odd(half_periods)) {
    sn = -sn;
    cn = -cn;
  }
  return {sn, cn, dn, am};
}

/// sn, cn, dn, am of u, parameter m.
template <class R>
Jacobi<R> jacobi(R u, R m) {
  return jacobi_of_complement(u, R(R(1) - m));
}

}  // namespace hamflow
