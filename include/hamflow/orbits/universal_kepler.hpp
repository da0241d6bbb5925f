// Kepler's equation in universal variables: the s with
//     r0 G1(s) + eta G2(s) + mu G3(s) = t,                                                    [Danby1988, Sect. 6.9]
// where r0 is the distance at the start, eta = r . v and beta = 2 mu/r0 - v^2. The left side grows with s, because its
// derivative is the distance r(s). The root can therefore be bracketed, and the iteration cannot fail without notice.
#pragma once

#include "hamflow/orbits/stumpff.hpp"

namespace hamflow {

/// The number type for computations in which accuracy matters more than speed. For double it is long double, whose 11
/// additional bits keep the rounding of a whole computation below the effect of one unit in its inputs.
template <class R>
struct CarefulNumber {
  using type = R;
};
template <>
struct CarefulNumber<double> {
  using type = long double;
};

/// The left side of Kepler's equation, and its derivatives for Newton's method.
template <class R>
struct UniversalTime {
  UniversalFunctions<R> g;
  R time;
  R distance;   // d time/ds
  R slope;      // d distance/ds
  R curvature;  // d slope/ds
  R magnitude;  // the sum of the sizes of the terms of time
};

/// A start in universal variables. r0 = 0 is allowed if eta = 0 (a collision orbit).
template <class R>
struct UniversalStart {
  R r0;
  R eta;
  R mu;
  R beta;

  UniversalTime<R> at(const R& s) const {
    const UniversalFunctions<R> g = universal_functions(beta, s);
    const R first = r0 * g.g1;
    const R second = eta * g.g2;
    const R third = mu * g.g3;
    const R zeta = mu - beta * r0;
    return {g,
            first + second + third,
            r0 * g.g0 + eta * g.g1 + mu * g.g2,
            eta * g.g0 + zeta * g.g1,
            zeta * g.g0 - beta * eta * g.g1,
            abs(first) + abs(second) + abs(third)};
  }
};

namespace detail {

/// Returns t minus the nearest whole number of periods. For many periods the product has a rounding error of one unit
/// of t.
template <class R>
R reduced_by_period(R t, const R& period) {
  // A whole number has at most the digits of long double in one pass; 64 passes are all exponents of quad.
  for (int k = 0; k < 300 && period < R(2) * abs(t); ++k) {
    const long double turns = std::nearbyint(static_cast<long double>(t / period));
    if (!(std::fabs(turns) <= std::numeric_limits<long double>::max())) return t;
    t = t - R(turns) * period;
  }
  return t;
}
inline long double reduced_by_period(long double t, long double period) {
  return std::isfinite(period) ? std::remainder(t, period) : t;  // exact
}

/// Returns an upper bound of the root. `t` > 0, and at most a period on an ellipse.
template <class R>
R bound_of_root(const UniversalStart<R>& start, const R& t) {
  if (R(0) < start.beta) return full_turn<R>() / sqrt(start.beta);
  const R root = sqrt(-start.beta);
  const R beyond = R(1) + R(1) / R(1024);                   // a margin larger than the rounding of the bound
  const auto below_sinh = [&](const R& s, const R& sine) {  // the smaller of s and asinh(sine)/root
    const R y = R(1) < sine ? inverse_sinh(sine) : sine;
    return y < root * s ? R(y / root) : s;
  };
  // At or after the pericentre mu G3 <= t. G3 >= s^3/6, or (sinh y - y)/root^3 on a hyperbola, then bounds s.
  R s = pow(R(6) * t / start.mu, R(1) / R(3)) * beyond;
  s = below_sinh(s, root * (-start.beta * t / start.mu + s));
  if (start.eta < R(0)) {  // to the pericentre: sinh y = root |eta|/(mu e), e >= 1
    const R to_pericentre = -start.eta / start.mu;
    s += below_sinh(to_pericentre, root * to_pericentre);
  } else if (R(0) < start.r0) {  // r0 G1 <= t, and G1 >= s
    const R by_distance = t / start.r0;
    if (by_distance < s) s = by_distance;
    s = below_sinh(s, root * by_distance);
  }
  return s * beyond;
}

}  // namespace detail

/// The number type for the first search of a root in R.
template <class R>
struct CoarseNumber {
  using type = long double;
};
template <>
struct CoarseNumber<long double> {
  using type = double;
};

/// Finds the root of Kepler's equation for t >= 0, and the functions there. On an ellipse, t is at most a period. It
/// uses Laguerre's method within a bracket, and bisection if a step would leave the bracket.   [Danby1988, ch. 6]
/// @returns false if no root is found, for inputs that are not finite; it never returns an inexact root
template <class R>
bool solve_universal_kepler(const UniversalStart<R>& start, const R& t, R& s, UniversalTime<R>& found) {
  const R epsilon = std::numeric_limits<R>::epsilon();
  if (t == R(0)) {
    s = R(0);
    found = start.at(s);
    return true;
  }
  R low(0);
  R high = detail::bound_of_root(start, t);
  if (!(R(0) < high && high <= std::numeric_limits<R>::max())) return false;
  s = R(0) < start.r0 && t / start.r0 < high ? t / start.r0 : high / R(2);
  if constexpr (!std::is_same_v<R, double>) {
    using Coarse = typename CoarseNumber<R>::type;
    const auto coarse = [](const R& x) { return static_cast<Coarse>(x); };
    Coarse guess;
    UniversalTime<Coarse> at_guess;
    const UniversalStart<Coarse> coarse_start{coarse(start.r0), coarse(start.eta), coarse(start.mu),
                                              coarse(start.beta)};
    if (solve_universal_kepler(coarse_start, coarse(t), guess, at_guess) && R(guess) < high) s = R(guess);
  }
  // Bisection alone needs as many steps as R has binary digits and exponents.
  for (int k = 0; k < 40000; ++k) {
    found = start.at(s);
    const R residual = found.time - t;
    if (!(abs(residual) <= std::numeric_limits<R>::max())) return false;
    if (residual < R(0)) {
      low = s;
    } else {
      high = s;
    }
    const R rounding = epsilon * (found.magnitude + t);
    if (abs(residual) <= rounding || abs(residual) <= epsilon * found.distance * s) return true;
    if (high - low <= epsilon * high) return true;
    const R first = R(4) * found.distance;
    const R inside = first * first - R(20) * residual * found.slope;
    const R step = -R(5) * residual / (found.distance + sqrt(abs(inside)));
    const R next = s + step;
    // The error after this step is of third order. If it is below the rounding, so are the third-order terms of the
    // functions at s + step.
    const R of_s = step / s;
    const R of_distance = step * found.slope / found.distance;
    const R of_slope = step * step * found.curvature / found.distance;
    if (abs(of_s) * (of_s * of_s + of_distance * of_distance + abs(of_slope)) < epsilon / R(4)) {
      const R half = step / R(2);
      UniversalFunctions<R>& g = found.g;
      g.g3 += step * (g.g2 + half * g.g1);
      g.g2 += step * (g.g1 + half * g.g0);
      g.g1 += step * (g.g0 - half * start.beta * g.g1);
      g.g0 = R(1) - start.beta * g.g2;
      found.distance += step * (found.slope + half * found.curvature);
      s = next;
      return true;
    }
    if (low < next && next < high) {
      s = next;
    } else {
      s = low + (high - low) / R(2);
    }
  }
  return false;
}

}  // namespace hamflow
