// **Constrained**: a Hamiltonian H = p^T M^-1 p/2 + V(q) with constraints g(q) = 0, kept by forces along the rows of
// g': q' = M^-1 p, p' = -V' - g'^T lambda.   [HLW2006, Sect. VII.1.1; Sonnleitner2010, p. 22]
//
// Along a motion g' M^-1 p = 0 as well, and d^2 g/dt^2 = 0 gives the multipliers as functions of the state,
//     (g' M^-1 g'^T) lambda = g'' (v, v) - g' M^-1 V',   v = M^-1 p.
// A problem gives constraints(q) as a template over the number type; dual numbers differentiate it.
#pragma once

#include <vector>

#include "hamflow/core/concepts.hpp"
#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/core/pool.hpp"

namespace hamflow {

/// The gradients of several functions of N coordinates, one for each constraint.
template <class S, std::size_t N>
using Gradients = std::vector<Vector<S, N>, PoolAllocator<Vector<S, N>>>;

template <class P>
concept Constrained = Problem<P> && HasConstraints<P> &&
    (HasConstraintGradients<P> || (detail::OfFixedSize<P> && HasConstraints<P, GradientDual<P>>));

/// g(q), one number for each constraint.
template <Constrained P, class S, std::size_t N>
Vector<S, dynamic> constraints(const P& problem, const Vector<S, N>& q) {
  const auto values = problem.constraints(q);
  Vector<S, dynamic> all(values.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = values[k];
  return all;
}

/// g'(q), row by row.
template <Constrained P, class S, std::size_t N>
Gradients<S, N> constraint_gradients(const P& problem, const Vector<S, N>& q) {
  if constexpr (HasConstraintGradients<P, S>) {
    return problem.constraint_gradients(q);
  } else {
    Vector<Dual<S, N>, N> seeded{};
    for (std::size_t i = 0; i < N; ++i) seeded[i] = Dual<S, N>::variable(q[i], i);
    Gradients<S, N> rows;
    for (const auto& value : problem.constraints(seeded)) rows.push_back(value.slope);
    return rows;
  }
}

/// M^-1 x for T quadratic in p; for H(q, p, t) the entries of the time are 0.
template <class P, class S, std::size_t N>
Vector<S, N> inverse_mass_times(const P& problem, const Vector<S, N>& x) {
  Vector<S, N> out = zeros_like(x);
  if constexpr (requires { problem.inverse_mass_times(x, out); }) {
    problem.inverse_mass_times(x, out);
  } else {
    velocity(problem, x, out);
  }
  return out;
}

template <class S, std::size_t N>
S dot(const Vector<S, N>& a, const Vector<S, N>& b) {
  S sum = a[0] * b[0];
  for (std::size_t i = 1; i < a.size(); ++i) sum = sum + a[i] * b[i];
  return sum;
}

/// rows x.
template <class S, std::size_t N>
Vector<S, dynamic> products(const Gradients<S, N>& rows, const Vector<S, N>& x) {
  Vector<S, dynamic> all(rows.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = dot(rows[k], x);
  return all;
}

/// lambda with (rows M^-1 rows^T) lambda = right: elimination without pivoting, which a positive definite matrix does
/// not need. There are no branches, so a recording stays valid.   [Higham2002, Sect. 10.1]
/// @param with_mass M^-1 of each row
template <class S, std::size_t N>
Vector<S, dynamic> multipliers(const Gradients<S, N>& rows, const Gradients<S, N>& with_mass,
                               Vector<S, dynamic> right) {
  const std::size_t m = rows.size();
  std::vector<S, PoolAllocator<S>> a(m * m);
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < m; ++j) a[i * m + j] = dot(rows[i], with_mass[j]);
  }
  for (std::size_t k = 0; k < m; ++k) {
    for (std::size_t i = k + 1; i < m; ++i) {
      const S factor = a[i * m + k] / a[k * m + k];
      for (std::size_t j = k + 1; j < m; ++j) a[i * m + j] = a[i * m + j] - factor * a[k * m + j];
      right[i] = right[i] - factor * right[k];
    }
  }
  for (std::size_t k = m; k-- > 0;) {
    for (std::size_t j = k + 1; j < m; ++j) right[k] = right[k] - a[k * m + j] * right[j];
    right[k] = right[k] / a[k * m + k];
  }
  return right;
}

}  // namespace hamflow
