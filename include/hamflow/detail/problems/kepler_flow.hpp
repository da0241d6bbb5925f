// Exact motion in the potential V(r) = -k/r on every conic, by universal variables: with dt = r ds, kappa = k/mu,
// beta = 2 kappa/r0 - v0^2 and eta = q0 . v0
//     r(s) = r0 G0 + eta G1 + kappa G2,   t(s) = r0 G1 + eta G2 + kappa G3,   G_n = s^n c_n(beta s^2),
// where c_n are Stumpff's functions.   [Danby1988, Sect. 6.9; ReinTamayo2015] The same formulas hold for ellipse,
// parabola and hyperbola; k < 0 repels. On a line (l = 0) the motion continues after the collision as the limit of
// narrow ellipses, that is, it returns.
#pragma once

#include <limits>
#include <type_traits>

#include "hamflow/core/number.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/numerics/root.hpp"

namespace hamflow {

/// c_n(z) = sum_j (-z)^j/(2 j + n)!, n = 0 .. 3: cos sqrt z, sin(sqrt z)/sqrt z, (1 - c_0)/z, (1 - c_1)/z.
template <class R>
struct Stumpff {
  R c0, c1, c2, c3;
};

template <class R>
Stumpff<R> stumpff(R z) {
  if (abs(z) < R(4)) {
    // The series; its terms fall by z/((2 j + 2)(2 j + 3)) < 2/3 from the first on.
    R c2(0);
    R c3(0);
    R term2 = R(1) / R(2);
    R term3 = R(1) / R(6);
    for (int j = 1; j < 60 && abs(term2) > std::numeric_limits<R>::epsilon() * abs(c2) / R(4); ++j) {
      c2 += term2;
      c3 += term3;
      term2 *= -z / R((2 * j + 1) * (2 * j + 2));
      term3 *= -z / R((2 * j + 2) * (2 * j + 3));
    }
    return {R(1) - z * c2, R(1) - z * c3, c2, c3};
  }
  const R x = sqrt(R(abs(z)));
  const R half = z > R(0) ? sin(x / R(2)) : sinh(x / R(2));
  const R c0 = z > R(0) ? cos(x) : cosh(x);
  const R c1 = (z > R(0) ? sin(x) : sinh(x)) / x;
  return {c0, c1, R(2) * half * half / abs(z), (R(1) - c1) / z};
}

namespace detail {
/// The motion as a function of the universal variable s.
struct UniversalMotion {
  using L = long double;
  L r0, eta, kappa, beta;

  L time(L s) const {
    const Stumpff<L> c = stumpff(beta * s * s);
    return s * (r0 * c.c1 + s * (eta * c.c2 + s * kappa * c.c3));
  }
  /// dt/ds, the distance from the centre.
  L radius(L s) const {
    const Stumpff<L> c = stumpff(beta * s * s);
    return r0 * c.c0 + s * (eta * c.c1 + s * kappa * c.c2);
  }
};

/// s at time t, at most half a period from 0. t(s) is monotone.
inline long double universal_variable(const UniversalMotion& motion, long double t) {
  using L = long double;
  // The bracket: a whole period of s, or doubling from a value at which no exponential is large yet.
  const L sign = t < 0 ? -1 : 1;
  L low = 0;
  L high = sign * 2 * pi_value<L>() / sqrt(motion.beta);
  if (!(motion.beta > 0)) {
    high = t / motion.r0;
    if (motion.beta < 0 && abs(high) * sqrt(-motion.beta) > 1) high = sign / sqrt(-motion.beta);
    while (abs(motion.time(high)) < abs(t)) {
      low = high;
      high = 2 * high;
    }
  }
  const L s =
      bracketed_root([&](L x) { return motion.time(x) - t; }, low, high, motion.time(low) - t, motion.time(high) - t);
  // The bracket has a width of up to two units of s; a step of Newton reduces the error to the rounding of t(s).
  const L step = (motion.time(s) - t) / motion.radius(s);
  return std::abs(step) <= 4 * std::numeric_limits<L>::epsilon() * std::abs(s) ? s - step : s;
}

inline Start<long double, 2> universal_kepler_flow(long double k, long double mass, const Vector<long double, 2>& q0,
                                                   const Vector<long double, 2>& p0, long double t) {
  using R = long double;
  const R kappa = k / mass;
  const Vector<R, 2> v0{p0[0] / mass, p0[1] / mass};
  const R r0 = hypot(q0[0], q0[1]);
  const R eta = q0[0] * v0[0] + q0[1] * v0[1];
  const R beta = R(2) * kappa / r0 - (v0[0] * v0[0] + v0[1] * v0[1]);
  if (beta > R(0)) {
    const R period = R(2) * pi_value<R>() * kappa / (beta * sqrt(beta));
    if (abs(t) * R(std::numeric_limits<double>::epsilon()) >
        period / R(4)) {  // the rounding of t is as large as the phase
      constexpr R none = std::numeric_limits<R>::quiet_NaN();
      return {{none, none}, {none, none}};
    }
    t -= period * nearbyint(t / period);
  }
  if (t == R(0)) return {q0, p0};
  const R s = universal_variable(UniversalMotion{r0, eta, kappa, beta}, t);

  const Stumpff<R> c = stumpff(beta * s * s);
  const R g1 = s * c.c1;
  const R g2 = s * s * c.c2;
  const R r = r0 * c.c0 + eta * g1 + kappa * g2;
  const R f = -kappa * g2 / r0;  // less 1
  const R g = r0 * g1 + eta * g2;
  const R f_rate = -kappa * g1 / (r * r0);
  const R g_rate = -kappa * g2 / r;  // less 1
  Start<R, 2> now{};
  for (std::size_t i = 0; i < 2; ++i) {
    now.q[i] = q0[i] + (f * q0[i] + g * v0[i]);
    now.p[i] = p0[i] + (mass * f_rate * q0[i] + g_rate * p0[i]);
  }
  return now;
}
}  // namespace detail

/// The state after time t, computed in long double.
template <class R>
requires std::is_floating_point_v<R> Start<R, 2> kepler_flow(R k, R mass, const Vector<R, 2>& q0,
                                                             const Vector<R, 2>& p0, R t) {
  using L = long double;
  const Start<L, 2> now = detail::universal_kepler_flow(static_cast<L>(k), static_cast<L>(mass), cast<L>(q0),
                                                        cast<L>(p0), static_cast<L>(t));
  return {cast<R>(now.q), cast<R>(now.p)};
}

}  // namespace hamflow
