// The derivatives of a Hamiltonian: the problem's own functions if it has them, otherwise dual numbers. Methods call
// these functions and never the members of a problem. S is the working number type: a problem with double parameters
// can be evaluated in dual numbers over double.
#pragma once

#include "hamflow/core/concepts.hpp"

namespace hamflow {

/// T(p).
template <class P, class S>
S kinetic_energy(const P& problem, const VectorOf<P, S>& p) {
  return problem.kinetic(p);
}

/// V(q).
template <class P, class S>
S potential_energy(const P& problem, const VectorOf<P, S>& q) {
  return problem.potential(q);
}

/// The number of degrees of freedom.
template <class P>
constexpr std::size_t degrees_of_freedom(const P& problem) {
  if constexpr (P::dimension == dynamic) {
    return problem.size();
  } else {
    return P::dimension;
  }
}

/// H(q, p), without any shift.
template <class P, class S, std::size_t N>
S energy(const P& problem, const Vector<S, N>& q, const Vector<S, N>& p) {
  if constexpr (detail::HasEnergy<P, S>) {
    return problem.energy(q, p);
  } else {
    return problem.kinetic(p) + problem.potential(q);
  }
}

namespace detail {
/// The gradient of f at x, carried by dual numbers.
template <class F, class S, std::size_t N>
void differentiate(const F& f, const Vector<S, N>& x, Vector<S, N>& out) {
  static_assert(N != dynamic, "hamflow: a problem of dynamic size must define velocity and force");
  Vector<Dual<S, N>, N> seeded{};
  for (std::size_t k = 0; k < N; ++k) seeded[k] = Dual<S, N>::variable(x[k], k);
  out = f(seeded).slope;
}
}  // namespace detail

/// v = dT/dp.
template <class P, class S, std::size_t N>
void velocity(const P& problem, const Vector<S, N>& p, Vector<S, N>& v) {
  if constexpr (HasVelocity<P, S>) {
    problem.velocity(p, v);
  } else {
    detail::differentiate([&](const auto& x) { return problem.kinetic(x); }, p, v);
  }
}

/// f = -dV/dq.
template <class P, class S, std::size_t N>
void force(const P& problem, const Vector<S, N>& q, Vector<S, N>& f) {
  if constexpr (HasForce<P, S>) {
    problem.force(q, f);
  } else {
    detail::differentiate([&](const auto& x) { return -problem.potential(x); }, q, f);
  }
}

/// v = factor dT/dp, the increment of a drift. A problem that defines it multiplies its constants by the factor instead
/// of the result, which makes the chain of dependent operations between two forces shorter by one. It is odd in the
/// factor, bit for bit, like the product.
template <class P, class F, class S, std::size_t N>
void scaled_velocity(const P& problem, const F& factor, const Vector<S, N>& p, Vector<S, N>& v) {
  if constexpr (HasScaledVelocity<P, F, S>) {
    problem.scaled_velocity(factor, p, v);
  } else {
    velocity(problem, p, v);
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = factor * v[i];
  }
}

/// f = -factor dV/dq, the increment of a kick. As for scaled_velocity, a problem may multiply its constants instead.
template <class P, class F, class S, std::size_t N>
void scaled_force(const P& problem, const F& factor, const Vector<S, N>& q, Vector<S, N>& f) {
  if constexpr (HasScaledForce<P, F, S>) {
    problem.scaled_force(factor, q, f);
  } else {
    force(problem, q, f);
    for (std::size_t i = 0; i < f.size(); ++i) f[i] = factor * f[i];
  }
}

/// out[i][j] = d^2 V / dq_i dq_j.
template <class P, class S, std::size_t N>
void potential_hessian(const P& problem, const Vector<S, N>& q, Matrix<S, N>& out) {
  if constexpr (HasPotentialHessian<P, S>) {
    problem.potential_hessian(q, out);
  } else if constexpr (HasForceAndHessian<P, S>) {
    Vector<S, N> f = zeros_like(q);
    problem.force_and_hessian(q, f, out);
  } else {
    static_assert(N != dynamic, "hamflow: a problem of dynamic size has to give its Hessian by hand");
    Vector<Dual<S, N>, N> seeded{};
    Vector<Dual<S, N>, N> f{};
    for (std::size_t k = 0; k < N; ++k) seeded[k] = Dual<S, N>::variable(q[k], k);
    force(problem, seeded, f);
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) out[i][j] = -f[i].slope[j];
    }
  }
}

/// Force and Hessian together, because they share square roots and divisions.
template <class P, class S, std::size_t N>
void force_and_hessian(const P& problem, const Vector<S, N>& q, Vector<S, N>& f, Matrix<S, N>& hessian) {
  if constexpr (HasForceAndHessian<P, S>) {
    problem.force_and_hessian(q, f, hessian);
  } else {
    force(problem, q, f);
    potential_hessian(problem, q, hessian);
  }
}

/// dq = dH/dq, dp = dH/dp.
template <class P, class S, std::size_t N>
void gradient(const P& problem, const Vector<S, N>& q, const Vector<S, N>& p, Vector<S, N>& dq, Vector<S, N>& dp) {
  if constexpr (HasGradient<P, S>) {
    problem.gradient(q, p, dq, dp);
  } else if constexpr (Separable<P>) {
    force(problem, q, dq);
    for (std::size_t i = 0; i < q.size(); ++i) dq[i] = -dq[i];
    velocity(problem, p, dp);
  } else {
    static_assert(N != dynamic, "hamflow: a problem of dynamic size has to give its gradient by hand");
    using D = Dual<S, 2 * N>;
    Vector<D, N> dual_q{};
    Vector<D, N> dual_p{};
    for (std::size_t k = 0; k < N; ++k) {
      dual_q[k] = D::variable(q[k], k);
      dual_p[k] = D::variable(p[k], N + k);
    }
    const D h = problem.energy(dual_q, dual_p);
    for (std::size_t k = 0; k < N; ++k) {
      dq[k] = h.slope[k];
      dp[k] = h.slope[N + k];
    }
  }
}

/// T if H = T(p) + V(q), else p . dH/dp: the scale of the energy that a motion exchanges. A problem behind virtual
/// calls computes it itself, since it knows only at run time whether H is T + V.
template <class P, class S, std::size_t N>
S kinetic_part(const P& problem, const Vector<S, N>& q, const Vector<S, N>& p) {
  if constexpr (requires { problem.kinetic_part(q, p); }) {
    return problem.kinetic_part(q, p);
  } else if constexpr (Separable<P>) {
    return problem.kinetic(p);
  } else {
    Vector<S, N> dq = zeros_like(q);
    Vector<S, N> dp = zeros_like(p);
    gradient(problem, q, p, dq, dp);
    S sum(0);
    for (std::size_t i = 0; i < p.size(); ++i) sum += p[i] * dp[i];
    return sum;
  }
}

/// Hamilton's equations: dq = q' = dH/dp, dp = p' = -dH/dq. Always inlined: in a loop over steps, a call would pass the
/// state through memory.
template <class P, class S, std::size_t N>
[[gnu::always_inline]] inline void motion(const P& problem, const Vector<S, N>& q, const Vector<S, N>& p,
                                          Vector<S, N>& dq, Vector<S, N>& dp) {
  if constexpr (Separable<P>) {
    velocity(problem, p, dq);
    force(problem, q, dp);
  } else {
    gradient(problem, q, p, dp, dq);
    for (std::size_t i = 0; i < dp.size(); ++i) dp[i] = -dp[i];
  }
}

/// M^-1, the constant Hessian of T, column by column: velocity is linear in p.
template <class P>
Matrix<RealOf<P>, P::dimension> inverse_mass_matrix(const P& problem) {
  using R = RealOf<P>;
  constexpr std::size_t n = P::dimension;
  const std::size_t size = degrees_of_freedom(problem);
  Matrix<R, n> inverse = zero_matrix(zeros<R, n>(size));
  for (std::size_t j = 0; j < size; ++j) {
    Vector<R, n> unit = zeros<R, n>(size);
    Vector<R, n> column = zeros<R, n>(size);
    unit[j] = R(1);
    velocity(problem, unit, column);
    for (std::size_t i = 0; i < size; ++i) inverse[i][j] = column[i];
  }
  return inverse;
}

/// All second derivatives of H: qq[i][j] = d^2 H/dq_i dq_j, qp[i][j] = d^2 H/dq_i dp_j, pp[i][j] = d^2 H/dp_i dp_j.
template <class P, class S, std::size_t N>
void hessian(const P& problem, const Vector<S, N>& q, const Vector<S, N>& p, Matrix<S, N>& qq, Matrix<S, N>& qp,
             Matrix<S, N>& pp) {
  if constexpr (HasHessian<P, S>) {
    problem.hessian(q, p, qq, qp, pp);
  } else if constexpr (QuadraticKinetic<P> && std::is_same_v<S, RealOf<P>>) {
    potential_hessian(problem, q, qq);
    qp = zero_matrix(q);
    pp = inverse_mass_matrix(problem);
  } else {
    static_assert(N != dynamic, "hamflow: a problem of dynamic size has to give its Hessian by hand");
    using D = Dual<S, 2 * N>;
    Vector<D, N> dual_q{};
    Vector<D, N> dual_p{};
    Vector<D, N> dq{};
    Vector<D, N> dp{};
    for (std::size_t k = 0; k < N; ++k) {
      dual_q[k] = D::variable(q[k], k);
      dual_p[k] = D::variable(p[k], N + k);
    }
    gradient(problem, dual_q, dual_p, dq, dp);
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) {
        qq[i][j] = dq[i].slope[j];
        qp[i][j] = dq[i].slope[N + j];
        pp[i][j] = dp[i].slope[N + j];
      }
    }
  }
}

}  // namespace hamflow
