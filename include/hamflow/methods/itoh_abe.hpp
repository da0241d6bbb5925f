// The discrete gradient of coordinate increments: coordinates change one after the other, q1 .. qn, then p1 .. pn, and
//     DH_i = [H(z1_1 .. z1_i, z0_(i+1) ..) - H(z1_1 .. z1_(i-1), z0_i ..)]/(z1_i - z0_i).   [ItohAbe1988]
// Order 1, conserves any H, and the map contains no derivative of H; not symmetric. The quotient is computed from a
// recording of H (detail/numerics/slope.hpp): its rounding error is that of dH/dz_i for any increment, and it equals
// dH/dz_i if a coordinate does not move. Newton's method uses the exact Jacobian: dDH_i/dz_j, j < i, is the same
// quotient of dH/dz_j, and dDH_i/dz1_i follows by dual numbers through the quotient.
#pragma once

#include "hamflow/detail/methods/implicit/discrete_gradient.hpp"
#include "hamflow/detail/methods/implicit/implicit_method.hpp"
#include "hamflow/detail/methods/implicit/large_systems.hpp"
#include "hamflow/detail/methods/implicit/recorded_energy.hpp"

namespace hamflow {

inline MethodInfo coordinate_increment_claims() {
  return {
      .name = "itoh-abe",
      .summary =
          "coordinate increments of Itoh and Abe: conserves any H, uses only values of H (and derivatives to solve)",
      .reference = "ItohAbe1988; HLW2006, Sect. V.5",
      .order = 1,
      .explicit_step = false,
      .weakly_reversible = true,
      .energy_conserving = Conservation::yes};
}

template <class P, class R>
class CoordinateIncrements {
 public:
  static constexpr std::size_t n = P::dimension;
  using Rows = Vector<R, dynamic>;
  explicit CoordinateIncrements(const P& problem) : energy_(problem), gradient_(problem, &tape_of_gradient<R, P, n>) {}

  static MethodInfo claims() { return coordinate_increment_claims(); }

  template <class S>
  Vector<S, dynamic> at(const P& problem, const Vector<S, dynamic>& z0, const Vector<S, dynamic>& u) const {
    Vector<S, dynamic> dh = u;
    Vector<S, dynamic> z = z0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      dh[i] = energy_.slope(problem, z, unit<S>(u.size(), i), u[i]);
      z[i] = z[i] + u[i];
    }
    return dh;
  }

  /// All quotients count as one gradient, and their derivatives as one Hessian.
  void linearise(const P& problem, const Rows& z0, const Rows& u, bool wanted, LinearisedGradient<R>& out,
                 Effort& effort) const {
    const std::size_t m = u.size();
    out.value = at(problem, z0, u);
    out.noise = out.value;
    for (R& each : out.noise) each = abs(each);
    ++effort.gradient;
    if (!wanted) return;
    ++effort.hessian;
    out.by_u = Matrix<R, dynamic>(m);
    Rows z = z0;
    for (std::size_t i = 0; i < m; ++i) {
      const Rows quotients = quotients_of_gradient(problem, z, u[i], i);
      for (std::size_t j = 0; j < m; ++j) out.noise[i] += abs(quotients[j]) * (abs(z0[j]) + abs(u[j]));
      for (std::size_t j = 0; j < i; ++j) out.by_u[i][j] = quotients[j];
      out.by_u[i][i] = by_increment(problem, z, u[i], i, out.value[i]);
      z[i] = z[i] + u[i];
    }
  }

 private:
  template <class S>
  static Vector<S, dynamic> unit(std::size_t size, std::size_t i) {
    Vector<S, dynamic> e(size);
    e[i] = S(R(1));
    return e;
  }
  static Rows gradient_at(const P& problem, const Rows& z) {
    const auto [q, p] = detail::coordinates_and_momenta<n>(z);
    Vector<R, n> dq = zeros_like(q);
    Vector<R, n> dp = zeros_like(q);
    gradient(problem, q, p, dq, dp);
    Rows all(z.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      all[i] = dq[i];
      all[q.size() + i] = dp[i];
    }
    return all;
  }
  /// [grad H(z + u e_i) - grad H(z)]/u.
  Rows quotients_of_gradient(const P& problem, const Rows& z, const R& u, std::size_t i) const {
    Rows quotients(z.size());
    const bool found = gradient_.slopes(problem, z, unit<R>(z.size(), i), u,
                                        [&](std::size_t k, const R& slope) { quotients[k] = slope; });
    if (found) return quotients;
    Rows end = z;
    end[i] = z[i] + u;
    const Rows before = gradient_at(problem, z);
    const Rows after = gradient_at(problem, end);
    for (std::size_t k = 0; k < z.size(); ++k) quotients[k] = (after[k] - before[k]) / u;
    return quotients;
  }
  /// The derivative of `value` = [H(z + u e_i) - H(z)]/u with respect to u.
  R by_increment(const P& problem, const Rows& z, const R& u, std::size_t i, const R& value) const {
    using D = Dual<R, 1>;
    Vector<D, dynamic> at(z.size());
    for (std::size_t k = 0; k < z.size(); ++k) at[k] = D(z[k]);
    D found;
    if (energy_.slope_on_tape(problem, at, unit<D>(z.size(), i), D::variable(u, 0), found)) return found.slope[0];
    Rows end = z;
    end[i] = z[i] + u;
    return (gradient_at(problem, end)[i] - value) / u;
  }

  RecordedEnergy<P, R> energy_;
  RecordedFunctions<P, R> gradient_;
};

/// The recipe of itoh-abe: simulate(problem, ItohAbe{}, q, p, h).
struct ItohAbe {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  template <class P>
  static constexpr bool accepts = Smooth<P>&& Traceable<P, RealOf<P>>;
  NewtonOptions options{};
  MethodInfo info() const { return described(coordinate_increment_claims(), options); }
  template <class P, class A>
  using Stepper = ImplicitMethod<P, A, DiscreteGradientStep<P, typename A::Real, CoordinateIncrements>>;
  /// H is evaluated for one coordinate after the other, so that the work of a step grows as the cube of their number.
  static constexpr std::size_t most_coordinates = 250;
  /// @throws Error for more coordinates than most_coordinates
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    if (degrees_of_freedom(problem) > most_coordinates) {
      throw Error("found " + std::to_string(degrees_of_freedom(problem)) + " coordinates; allowed at most " +
                  std::to_string(most_coordinates) +
                  ", because itoh-abe evaluates H for each coordinate and a step with more takes minutes; use "
                  "discrete-gradient");
    }
    return Stepper<P, A>(problem, for_unknowns(2 * degrees_of_freedom(problem), options));
  }
};

}  // namespace hamflow
