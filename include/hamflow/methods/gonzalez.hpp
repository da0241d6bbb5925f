// The midpoint discrete gradient in phase space:   [Gonzalez1996]
//     DH = g + c u,   g = grad H((z0 + z1)/2),   u = z1 - z0,   c = [H(z1) - H(z0) - g.u]/|u|^2,   c = 0 at u = 0.
// Order 2, symmetric, conserves any H; not symplectic. c u has the size |u|^2, and H(z1) - H(z0) - g.u has the size
// |u|^3. As a difference of two energies it would have a rounding error of epsilon |H|, and c u of epsilon |H|/|u|,
// which near an equilibrium is more than the motion. The change of H is computed from its recording
// (detail/numerics/slope.hpp), so that the rounding error of c u is epsilon |g| for any u.
#pragma once

#include "hamflow/detail/methods/implicit/discrete_gradient.hpp"
#include "hamflow/detail/methods/implicit/implicit_method.hpp"
#include "hamflow/detail/methods/implicit/large_systems.hpp"
#include "hamflow/detail/methods/implicit/recorded_energy.hpp"

namespace hamflow {

inline MethodInfo midpoint_gradient_claims() {
  return {.name = "discrete-gradient",
          .summary = "midpoint discrete gradient of Gonzalez: conserves any H",
          .reference = "Gonzalez1996; HLW2006, Sect. V.5",
          .order = 2,
          .explicit_step = false,
          .weakly_reversible = true,
          .symmetric = true,
          .reversible = true,
          .energy_conserving = Conservation::yes};
}

template <class P, class R>
class MidpointDiscreteGradient {
 public:
  static constexpr std::size_t n = P::dimension;
  using Rows = Vector<R, dynamic>;
  explicit MidpointDiscreteGradient(const P& problem) : energy_(problem) {}

  static MethodInfo claims() { return midpoint_gradient_claims(); }

  template <class S>
  Vector<S, dynamic> at(const P& problem, const Vector<S, dynamic>& z0, const Vector<S, dynamic>& u) const {
    Vector<S, dynamic> dh = gradient_at(problem, on_the_way(z0, u, R(0.5)));
    const S c = correction(problem, z0, u, dh);
    for (std::size_t i = 0; i < u.size(); ++i) dh[i] = dh[i] + c * u[i];
    return dh;
  }

  /// dDH/du = H''/2 + c I + u w^T with w = dc/du = [grad H(z1) - g - H'' u/2 - 2 c u]/|u|^2.
  void linearise(const P& problem, const Rows& z0, const Rows& u, bool wanted, LinearisedGradient<R>& out,
                 Effort& effort) const {
    const std::size_t m = u.size();
    const Rows middle = on_the_way(z0, u, R(0.5));
    const Rows g = gradient_at(problem, middle);
    const R square = dot(u, u);
    const R c = correction(problem, z0, u, g);
    out.value = g;
    for (std::size_t i = 0; i < m; ++i) out.value[i] = g[i] + c * u[i];
    out.noise = g;
    for (R& each : out.noise) each = abs(each);
    ++effort.gradient;
    if (wanted) {
      out.by_u = hessian_at(problem, middle);
      const Rows end = gradient_at(problem, on_the_way(z0, u, R(1)));
      ++effort.gradient;
      ++effort.hessian;
      Rows w(m);
      for (std::size_t i = 0; i < m; ++i) {
        R bend(0);
        for (std::size_t j = 0; j < m; ++j) {
          out.noise[i] += abs(out.by_u[i][j]) * (abs(z0[j]) + abs(u[j]));
          bend += out.by_u[i][j] * u[j] / R(2);
        }
        if (square > R(0)) w[i] = (end[i] - g[i] - bend - R(2) * c * u[i]) / square;
      }
      for (std::size_t i = 0; i < m; ++i) {
        for (std::size_t j = 0; j < m; ++j) out.by_u[i][j] = out.by_u[i][j] / R(2) + u[i] * w[j];
        out.by_u[i][i] += c;
      }
    }
    R work(0);
    for (std::size_t i = 0; i < m; ++i) work += out.noise[i] * abs(u[i]);
    for (std::size_t i = 0; square > R(0) && i < m; ++i) out.noise[i] += abs(u[i]) * work / square;
  }

 protected:
  /// z0 + part u.
  template <class S>
  static Vector<S, dynamic> on_the_way(const Vector<S, dynamic>& z0, const Vector<S, dynamic>& u, const R& part) {
    Vector<S, dynamic> z = z0;
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = z0[i] + part * u[i];
    return z;
  }
  template <class S>
  static S dot(const Vector<S, dynamic>& a, const Vector<S, dynamic>& b) {
    S sum(R(0));
    for (std::size_t i = 0; i < a.size(); ++i) sum = sum + a[i] * b[i];
    return sum;
  }
  /// The factor c. @param g grad H at the midpoint
  template <class S>
  S correction(const P& problem, const Vector<S, dynamic>& z0, const Vector<S, dynamic>& u,
               const Vector<S, dynamic>& g) const {
    const S square = dot(u, u);
    if (!(value_of(square) > R(0))) return S(R(0));
    return (energy_.slope(problem, z0, u, S(R(1))) - dot(g, u)) / square;
  }
  template <class S>
  static Vector<S, dynamic> gradient_at(const P& problem, const Vector<S, dynamic>& z) {
    const auto [q, p] = detail::coordinates_and_momenta<n>(z);
    Vector<S, n> dq = zeros_like(q);
    Vector<S, n> dp = zeros_like(q);
    gradient(problem, q, p, dq, dp);
    Vector<S, dynamic> all(z.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      all[i] = dq[i];
      all[q.size() + i] = dp[i];
    }
    return all;
  }
  static Matrix<R, dynamic> hessian_at(const P& problem, const Rows& z) {
    const auto [q, p] = detail::coordinates_and_momenta<n>(z);
    const std::size_t size = q.size();
    Matrix<R, n> qq = zero_matrix(q);
    Matrix<R, n> qp = qq;
    Matrix<R, n> pp = qq;
    hessian(problem, q, p, qq, qp, pp);
    Matrix<R, dynamic> all(2 * size);
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        all[i][j] = qq[i][j];
        all[i][size + j] = all[size + j][i] = qp[i][j];
        all[size + i][size + j] = pp[i][j];
      }
    }
    return all;
  }

 private:
  RecordedEnergy<P, R> energy_;
};

/// The recipe of discrete-gradient: simulate(problem, DiscreteGradient{}, q, p, h).
struct DiscreteGradient {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  template <class P>
  static constexpr bool accepts = Smooth<P>&& Traceable<P, RealOf<P>>;
  NewtonOptions options{};
  MethodInfo info() const { return described(midpoint_gradient_claims(), options); }
  template <class P, class A>
  using Stepper = ImplicitMethod<P, A, DiscreteGradientStep<P, typename A::Real, MidpointDiscreteGradient>>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, for_unknowns(2 * degrees_of_freedom(problem), options));
  }
};

}  // namespace hamflow
