// The Kepler drift of dual numbers: with its derivative by position, velocity, mu and time.
//
// The value is that of the plain drift. The derivative follows from f, g, f', g' at the root s of Kepler's equation,
// whose derivative is that of an implicit function; with
//     dG_k/ds = G_(k-1),   dG_k/dbeta = (k G_(k+2) - s G_(k+1))/2.                            [Danby1988, Sect. 6.9]
#pragma once

#include "hamflow/core/dual.hpp"
#include "hamflow/orbits/kepler_drift.hpp"

namespace hamflow {

namespace detail {

/// G_4 and G_5.
template <class R>
void higher_universal_functions(const R& beta, const R& s, const UniversalFunctions<R>& g, R& g4, R& g5) {
  const R square = s * s;
  const R x = beta * square;
  if (R(1) < abs(x)) {  // G_(k+2) = (s^k/k! - G_k)/beta
    g4 = (square / R(2) - g.g2) / beta;
    g5 = (square * s / R(6) - g.g3) / beta;
    return;
  }
  R term4 = square * square / R(24);
  R term5 = term4 * s / R(5);
  g4 = term4;
  g5 = term5;
  for (int k = 4; k < 1000; k += 2) {
    term4 = -term4 * x / R((k + 1) * (k + 2));
    term5 = -term5 * x / R((k + 2) * (k + 3));
    g4 += term4;
    g5 += term5;
    if (!(std::numeric_limits<R>::epsilon() * abs(g4) < abs(term4))) break;
  }
}

template <class R, std::size_t D>
UniversalFunctions<Dual<R, D>> dual_universal_functions(const Dual<R, D>& beta, const Dual<R, D>& s) {
  const UniversalFunctions<R> g = universal_functions(beta.value, s.value);
  R g4;
  R g5;
  higher_universal_functions(beta.value, s.value, g, g4, g5);
  const R half = R(1) / R(2);
  const auto made = [&](const R& value, const R& by_s, const R& by_beta) {
    Dual<R, D> x(value);
    for (std::size_t k = 0; k < D; ++k) x.slope[k] = by_s * s.slope[k] + by_beta * beta.slope[k];
    return x;
  };
  return {made(g.g0, -(beta.value * g.g1), -(s.value * g.g1) * half), made(g.g1, g.g0, (g.g3 - s.value * g.g2) * half),
          made(g.g2, g.g1, (R(2) * g4 - s.value * g.g3) * half), made(g.g3, g.g2, (R(3) * g5 - s.value * g4) * half)};
}

}  // namespace detail

template <class R, std::size_t D, std::size_t N>
Outcome kepler_drift(const Vector<Dual<R, D>, N>& r, const Vector<Dual<R, D>, N>& v, const Dual<R, D>& mu,
                     const Dual<R, D>& t, KeplerIncrements<Dual<R, D>, N>& out) {
  using S = Dual<R, D>;
  Vector<R, N> plain_r;
  Vector<R, N> plain_v;
  for (std::size_t i = 0; i < N; ++i) {
    plain_r[i] = r[i].value;
    plain_v[i] = v[i].value;
  }
  KeplerIncrements<R, N> plain;
  const Outcome outcome = kepler_drift(plain_r, plain_v, mu.value, t.value, plain);
  if (outcome != Outcome::done) return outcome;

  const S r0 = sqrt(detail::inner_product(r, r));
  S eta = detail::inner_product(r, v);
  const S beta = S(R(2)) * mu / r0 - detail::inner_product(v, v);
  S time = t;
  if (R(0) < beta.value) {
    const S period = S(detail::full_turn<R>()) * mu / (beta * sqrt(beta));
    const R rest = detail::reduced_by_period(t.value, period.value);
    time = t - S((t.value - rest) / period.value) * period;
    time.value = rest;
  }
  const bool backward = time.value < R(0);  // the motion with -v, forward
  if (backward) {
    time = -time;
    eta = -eta;
  }
  R root;
  UniversalTime<R> found;
  const UniversalStart<R> start{r0.value, eta.value, mu.value, beta.value};
  if (!solve_universal_kepler(start, time.value, root, found)) return Outcome::not_converged;
  S s(root);
  const UniversalFunctions<S> fixed = detail::dual_universal_functions(beta, s);
  const S residual = r0 * fixed.g1 + eta * fixed.g2 + mu * fixed.g3 - time;
  for (std::size_t k = 0; k < D; ++k) s.slope[k] = -residual.slope[k] / found.distance;
  const UniversalFunctions<S> g = detail::dual_universal_functions(beta, s);
  const S distance = r0 * g.g0 + eta * g.g1 + mu * g.g2;
  const S f_less_1 = -(mu * g.g2) / r0;
  const S g_of_v = (backward ? S(R(-1)) : S(R(1))) * (time - mu * g.g3);
  const S f_rate = (backward ? S(R(1)) : S(R(-1))) * (mu * g.g1) / (r0 * distance);
  const S g_rate_less_1 = -(mu * g.g2) / distance;
  for (std::size_t i = 0; i < N; ++i) {
    out.position[i] = f_less_1 * r[i] + g_of_v * v[i];
    out.velocity[i] = f_rate * r[i] + g_rate_less_1 * v[i];
    out.position[i].value = plain.position[i];
    out.velocity[i].value = plain.velocity[i];
    out.position_rest[i] = S(plain.position_rest[i]);
    out.velocity_rest[i] = S(plain.velocity_rest[i]);
  }
  return Outcome::done;
}

}  // namespace hamflow
