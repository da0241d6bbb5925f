// The Kepler drift: the motion of two bodies, r'' = -mu r/|r|^3, over any time, on any conic.
//
// It returns increments of r and v. With f - 1 = -mu G2/r0, g = t - mu G3, f' = -mu G1/(r0 r), g' - 1 = -mu G2/r,
//     dr = (f - 1) r + g v,   dv = f' r + (g' - 1) v,                                         [Danby1988, Sect. 6.9]
// the increments of a short drift have full relative accuracy, which compensated sums and the lattice preserve.
//
// In double a short step, below about a twelfth of a period, takes a fast path with few operations and no iteration.
// Everything else is computed in long double. Then r0, eta and beta are as exact as r and v, which matters near the
// parabola, where beta is a small difference, and over many periods, which multiply its error.
#pragma once

#include "hamflow/core/outcome.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/orbits/universal_kepler.hpp"

namespace hamflow {

/// The increments of position and velocity in a drift. The rests are the rounding errors of the increments in R. They
/// are set only if they are known and matter: after a long drift that ends much nearer to the centre than it began.
template <class R, std::size_t N>
struct KeplerIncrements {
  Vector<R, N> position;
  Vector<R, N> velocity;
  Vector<R, N> position_rest{};
  Vector<R, N> velocity_rest{};
};

template <class R>
struct Trace;  // detail/core/tape.hpp

namespace detail {

/// Whether numbers of this type record what is computed with them.
template <class R>
inline constexpr bool is_recording = std::is_same_v<R, Trace<double>>;

template <class R, std::size_t N>
R inner_product(const Vector<R, N>& a, const Vector<R, N>& b) {
  R sum = a[0] * b[0];
  for (std::size_t i = 1; i < N; ++i) sum += a[i] * b[i];
  return sum;
}

/// Returns |r x v|^2 in any dimension, with the accuracy of its terms.
template <class R, std::size_t N>
R squared_area_rate(const Vector<R, N>& r, const Vector<R, N>& v) {
  R sum(0);
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = i + 1; k < N; ++k) {
      const R part = r[i] * v[k] - r[k] * v[i];
      sum += part * part;
    }
  }
  return sum;
}

/// The present r and v, and the increments so far.
template <class R, std::size_t N>
struct DriftInParts {
  Vector<R, N> r;
  Vector<R, N> v;
  Vector<R, N> added_r{};
  Vector<R, N> added_v{};

  void move(const UniversalStart<R>& start, const UniversalTime<R>& end, const R& t) {
    const R f_less_1 = -start.mu * end.g.g2 / start.r0;
    const R g = t - start.mu * end.g.g3;
    const R f_rate = -start.mu * end.g.g1 / (start.r0 * end.distance);
    const R g_rate_less_1 = -start.mu * end.g.g2 / end.distance;
    for (std::size_t i = 0; i < N; ++i) {
      const R to_r = f_less_1 * r[i] + g * v[i];
      const R to_v = f_rate * r[i] + g_rate_less_1 * v[i];
      r[i] += to_r;
      v[i] += to_v;
      added_r[i] += to_r;
      added_v[i] += to_v;
    }
  }
};

/// Drifts for t > 0. Inbound on a hyperbola at r0 >> mu/|beta|, the terms of Kepler's equation grow like exp(y) with
/// y = s sqrt(-beta), while r decreases like exp(-y) until the pericentre at y_p. Their sum would lose a factor
/// exp(y_p) more accuracy than the motion itself. The inbound part is therefore divided into parts of y = 1 until y_p
/// < 1.44. beta is always taken from the start, because near the pericentre it would be a small difference.
template <class R, std::size_t N>
bool drift_forward(DriftInParts<R, N>& body, const R& mu, const R& beta, R t) {
  for (;;) {
    const UniversalStart<R> start{sqrt(inner_product(body.r, body.r)), inner_product(body.r, body.v), mu, beta};
    UniversalTime<R> end;
    if (beta < R(0) && start.eta < R(0)) {
      const R root = sqrt(-beta);
      const R mu_e = sqrt(mu * mu - beta * squared_area_rate(body.r, body.v));
      if (R(2) * mu_e < root * -start.eta) {  // sinh 1.44 = 2
        end = start.at(R(1) / root);
        if (end.time < t) {
          body.move(start, end, end.time);
          t = t - end.time;
          continue;
        }
      }
    }
    R s;
    if (!solve_universal_kepler(start, t, s, end)) return false;
    body.move(start, end, t);
    return true;
  }
}

template <class R, std::size_t N>
bool careful_drift(const Vector<R, N>& r, Vector<R, N> v, const R& mu, R t, KeplerIncrements<R, N>& out) {
  if (!(R(0) <= mu)) return false;
  if (mu == R(0)) {
    out.velocity = {};
    for (std::size_t i = 0; i < N; ++i) out.position[i] = v[i] * t;
    return true;
  }
  const R r0 = sqrt(inner_product(r, r));
  const R beta = R(2) * mu / r0 - inner_product(v, v);
  if (R(0) < beta) t = reduced_by_period(t, full_turn<R>() * mu / (beta * sqrt(beta)));
  const bool backward = t < R(0);  // the motion with -v, forward
  if (backward) {
    t = -t;
    for (std::size_t i = 0; i < N; ++i) v[i] = -v[i];
  }
  DriftInParts<R, N> body{r, v};
  if (!drift_forward(body, mu, beta, t)) return false;
  for (std::size_t i = 0; i < N; ++i) {
    out.position[i] = body.added_r[i];
    out.velocity[i] = backward ? -body.added_v[i] : body.added_v[i];
  }
  return true;
}

/// sum_n coefficient[n] x^n of 8 terms, by pairs, so that fewer operations wait for each other.
template <class V>
[[gnu::always_inline]] inline void sum_of_eight(const double (&c)[8], const V& x, V& sum) {
  const V x2 = x * x;
  const V low = (c[0] + c[1] * x) + (c[2] + c[3] * x) * x2;
  const V high = (c[4] + c[5] * x) + (c[6] + c[7] * x) * x2;
  sum = low + high * (x2 * x2);
}

/// A step is short if mu s^2/r0, beta s^2, eta s/r0 and the square of (mu s/r0)/v are below this number: less than a
/// twelfth of a period on a circle. Then the first omitted term of a series is 2^-68 of its sum, rounding errors of r0
/// and beta are not amplified, and the increments are smaller than the numbers that they are added to.
inline constexpr double short_step = 0.25;
// (-1)^n/(2 n + 2)! and (-1)^n/(2 n + 3)!.
inline constexpr double c2_series[8] = {1. / 2,       -1. / 24,        1. / 720,          -1. / 40320,
                                        1. / 3628800, -1. / 479001600, 1. / 87178291200., -1. / 20922789888000.};
inline constexpr double c3_series[8] = {1. / 6,        -1. / 120,         1. / 5040,           -1. / 362880,
                                        1. / 39916800, -1. / 6227020800., 1. / 1307674368000., -1. / 355687428096000.};

/// A short step, in double or in a vector of doubles with one body in each lane.
template <class V>
struct ShortKeplerStep {
  V r0;
  V eta;
  V mu;
  V t;
  V inverse_r0;
  V beta;
  V zeta;

  V s;
  V g1;
  V g2;
  V g3;
  V r;
  V correction;  // the last correction, relative to s

  [[gnu::always_inline]] ShortKeplerStep(const V& r0_, const V& eta_, const V& square_of_v, const V& mu_, const V& t_)
      : r0(r0_), eta(eta_), mu(mu_), t(t_) {
    inverse_r0 = 1 / r0;
    beta = 2 * mu * inverse_r0 - square_of_v;
    zeta = mu - beta * r0;
    // The first terms of s as a series in t.
    const V sigma = t * inverse_r0;
    const V u = eta * inverse_r0 * sigma;
    const V w = zeta * inverse_r0 * sigma * sigma;
    s = sigma * (1 - u * 0.5 + (u * u * 0.5 - w * (1. / 6)) + u * (w * (5. / 12) - u * u * 0.625));
  }

  /// Takes a step of Newton's method with second and third derivatives, then evaluates the functions at the new s by
  /// their Taylor series. Both have an error of (correction of s)^4.   [Danby1988, ch. 6]
  [[gnu::always_inline]] void correct() {
    const V square = s * s;
    const V x = beta * square;
    V c2, c3;
    sum_of_eight(c2_series, x, c2);
    sum_of_eight(c3_series, x, c3);
    g2 = square * c2;
    g3 = s * square * c3;
    g1 = s - beta * g3;
    const V g0 = 1 - beta * g2;
    r = r0 + (eta * g1 + zeta * g2);
    const V slope = eta * g0 + zeta * g1;
    const V curvature = zeta * g0 - beta * (eta * g1);
    const V inverse_r = 1 / r;
    const V newton = -((r0 * s - t) + (eta * g2 + zeta * g3)) * inverse_r;
    const V h = slope * inverse_r * 0.5;
    const V step = newton * (1 - newton * (h - newton * (2 * h * h - curvature * inverse_r * (1. / 6))));
    const V half = step * 0.5;
    const V third = step * (1. / 3);
    r += step * (slope + half * (curvature - third * beta * slope));
    g3 += step * (g2 + half * (g1 + third * g0));
    g2 += step * (g1 + half * (g0 - third * beta * g1));
    g1 += step * (g0 - half * beta * (g1 + third * g0));
    s += step;
    correction = step / s;
  }
};

/// The numbers of a body before a step, of which vectors have one in each lane.
template <class R>
struct ShortStepStart {
  R r0;
  R eta;
  R square_of_v;
  R mu;

  template <std::size_t N>
  static ShortStepStart of(const Vector<R, N>& r, const Vector<R, N>& v, const R& mu) {
    return {sqrt(inner_product(r, r)), inner_product(r, v), inner_product(v, v), mu};
  }
  /// Whether the step is short. False if a number is NaN.
  bool is_short(const R& s, const R& beta) const {
    const R square = s * s;
    const R limit_of_distance = short_step * r0;
    return R(0) < mu && mu * square < limit_of_distance && abs(eta * s) < limit_of_distance &&
           abs(beta * square) < R(short_step) && mu * mu * square < limit_of_distance * r0 * square_of_v;
  }
};

/// Whether the fourth power of the last correction is below a rounding.
template <class R>
bool is_small_correction(const R& relative) {
  return abs(relative) < R(1e-4);
}

template <class R, std::size_t N>
void set_increments(const Vector<R, N>& r, const Vector<R, N>& v, const R& f_less_1, const R& g, const R& f_rate,
                    const R& g_rate_less_1, KeplerIncrements<R, N>& out) {
  for (std::size_t i = 0; i < N; ++i) {
    out.position[i] = f_less_1 * r[i] + g * v[i];
    out.velocity[i] = f_rate * r[i] + g_rate_less_1 * v[i];
    out.position_rest[i] = 0;
    out.velocity_rest[i] = 0;
  }
}

/// Returns false if the step is not short, or if a number is NaN.
template <class R, std::size_t N>
bool short_drift(const Vector<R, N>& r, const Vector<R, N>& v, const R& mu, const R& t, KeplerIncrements<R, N>& out) {
  const auto start = ShortStepStart<R>::of(r, v, mu);
  ShortKeplerStep<R> step(start.r0, start.eta, start.square_of_v, mu, t);
  if (!start.is_short(step.s, step.beta)) return false;
  const auto has_converged = [&] {
    step.correct();
    return is_small_correction(step.correction);
  };
  if (!has_converged() && !has_converged()) return false;
  const R by_mass = mu * step.g2;
  const R inverse_r = R(1) / step.r;
  set_increments(r, v, R(-by_mass * step.inverse_r0), R(t - mu * step.g3),
                 R(-mu * step.g1 * step.inverse_r0 * inverse_r), R(-by_mass * inverse_r), out);
  return true;
}

/// L doubles that are computed side by side. The compiler divides them into what the processor has. They are never
/// passed by value, since how that is done depends on the processor.
template <std::size_t L>
struct Lanes {
  using Type [[gnu::vector_size(8 * L)]] = double;
};

/// Short drifts of L bodies side by side. All results have the bits of short_drift(). Returns false, and nothing is
/// known of `out`, if a step is not short, or needs a second correction.
/// @param r, v, attraction called with the lane
template <std::size_t L, class Position, class Velocity, class Attraction, std::size_t N>
[[gnu::always_inline]] inline bool short_drifts(const Position& r, const Velocity& v, const Attraction& attraction,
                                                double t, KeplerIncrements<double, N>* out) {
  using V = typename Lanes<L>::Type;
  V r0, eta, square_of_v, mu;
  for (std::size_t l = 0; l < L; ++l) {
    const auto start = ShortStepStart<double>::of(r(l), v(l), attraction(l));
    r0[l] = start.r0;
    eta[l] = start.eta;
    square_of_v[l] = start.square_of_v;
    mu[l] = start.mu;
  }
  ShortKeplerStep<V> step(r0, eta, square_of_v, mu, V{} + t);
  bool goes_on = true;
  for (std::size_t l = 0; l < L; ++l) {
    goes_on = goes_on && ShortStepStart<double>{r0[l], eta[l], square_of_v[l], mu[l]}.is_short(step.s[l], step.beta[l]);
  }
  if (!goes_on) return false;
  step.correct();
  for (std::size_t l = 0; l < L; ++l) goes_on = goes_on && is_small_correction<double>(step.correction[l]);
  if (!goes_on) return false;
  const V by_mass = mu * step.g2;
  const V inverse_r = 1 / step.r;
  const V f_less_1 = -by_mass * step.inverse_r0;
  const V g = step.t - mu * step.g3;
  const V f_rate = -mu * step.g1 * step.inverse_r0 * inverse_r;
  const V g_rate_less_1 = -by_mass * inverse_r;
  for (std::size_t l = 0; l < L; ++l) {
    set_increments(r(l), v(l), f_less_1[l], g[l], f_rate[l], g_rate_less_1[l], out[l]);
  }
  return true;
}

}  // namespace detail

/// Computes the increments of r and v over a time `t` of either sign, for mu = G m >= 0. In double the error is at most
/// 4 units in the last place of the largest component of position and of velocity, or the effect of one unit in the
/// inputs if that is larger. For types with more digits it is 64 units. Of the steps of a recording only short ones are
/// taken.
/// @returns not_converged if there is no such state: at a collision, or for inputs that are not finite or overflow
template <class R, std::size_t N>
Outcome kepler_drift(const Vector<R, N>& r, const Vector<R, N>& v, const R& mu, const R& t,
                     KeplerIncrements<R, N>& out) {
  if constexpr (std::is_same_v<R, double> || detail::is_recording<R>) {
    if (detail::short_drift(r, v, mu, t, out)) return Outcome::done;
  }
  if constexpr (detail::is_recording<R>) {
    return Outcome::not_converged;
  } else {
    using Careful = typename CarefulNumber<R>::type;
    KeplerIncrements<Careful, N> found{};
    if (!detail::careful_drift(cast<Careful>(r), cast<Careful>(v), Careful(mu), Careful(t), found)) {
      return Outcome::not_converged;
    }
    for (std::size_t i = 0; i < N; ++i) {
      out.position[i] = R(found.position[i]);
      out.velocity[i] = R(found.velocity[i]);
      out.position_rest[i] = R(found.position[i] - Careful(out.position[i]));
      out.velocity_rest[i] = R(found.velocity[i] - Careful(out.velocity[i]));
      const R size = abs(out.position[i]) + abs(out.velocity[i]);
      if (!(size <= std::numeric_limits<R>::max())) return Outcome::not_converged;
    }
    return Outcome::done;
  }
}

/// Drifts of several bodies: calls add(i, increments) for each body i = body(0), ..., body(count - 1). The increments
/// are those of kepler_drift() to the last bit; in double, short drifts are computed four or two at a time.
/// @param attraction attraction(i) is mu of body i
/// @returns not_converged at the first body without such a state; those before it have been added
template <class R, class Spaces, class Body, class Attraction, class Add>
Outcome kepler_drifts(const Spaces& r, const Spaces& v, std::size_t count, const Body& body,
                      const Attraction& attraction, const R& t, const Add& add) {
  constexpr std::size_t most = 4;
  KeplerIncrements<R, 3> by[most];
  const auto add_short = [&]<std::size_t L>(std::integral_constant<std::size_t, L>, std::size_t k) {
    if (!detail::short_drifts<L>(
            [&](std::size_t l) -> const auto& { return r[body(k + l)]; },
            [&](std::size_t l) -> const auto& { return v[body(k + l)]; },
            [&](std::size_t l) { return attraction(body(k + l)); }, t, by)) {
      return false;
    }
    for (std::size_t l = 0; l < L; ++l) add(body(k + l), by[l]);
    return true;
  };
  for (std::size_t k = 0; k < count;) {
    if constexpr (std::is_same_v<R, double>) {
      if (k + 4 <= count && add_short(std::integral_constant<std::size_t, 4>(), k)) {
        k += 4;
        continue;
      }
      if (k + 2 <= count && add_short(std::integral_constant<std::size_t, 2>(), k)) {
        k += 2;
        continue;
      }
    }
    const std::size_t i = body(k);
    const Outcome outcome = kepler_drift(r[i], v[i], attraction(i), t, by[0]);
    if (outcome != Outcome::done) return outcome;
    add(i, by[0]);
    ++k;
  }
  return Outcome::done;
}

/// Advances r and v. They are unchanged if the outcome is not `done`.
template <class R, std::size_t N>
Outcome advance_on_conic(Vector<R, N>& r, Vector<R, N>& v, const R& mu, const R& t) {
  KeplerIncrements<R, N> add;
  const Outcome outcome = kepler_drift(r, v, mu, t, add);
  if (outcome != Outcome::done) return outcome;
  for (std::size_t i = 0; i < N; ++i) {
    r[i] = (r[i] + add.position[i]) + add.position_rest[i];
    v[i] = (v[i] + add.velocity[i]) + add.velocity_rest[i];
  }
  return outcome;
}

}  // namespace hamflow
