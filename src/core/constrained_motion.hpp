// Motion with constraints: the vector field whose multipliers are functions of the state, and the projection onto the
// constraints.
#pragma once

#include <limits>

#include "hamflow/core/constraints.hpp"
#include "hamflow/core/math.hpp"

namespace hamflow {

/// Projects a state onto the constraints, to rounding: q by Newton's method along M^-1 g'^T, p onto the tangent space.
template <class P, class S, std::size_t N>
void move_onto_constraints(const P& problem, Vector<S, N>& q, Vector<S, N>& p) {
  constexpr int most = 50;
  Gradients<S, N> rows;
  Gradients<S, N> with_mass;
  const auto linearise = [&] {
    rows = constraint_gradients(problem, q);
    with_mass.clear();
    for (const auto& row : rows) with_mass.push_back(inverse_mass_times(problem, row));
  };
  for (int k = 0; k < most; ++k) {
    linearise();
    const Vector<S, dynamic> lambda = multipliers(rows, with_mass, constraints(problem, q));
    S moved(0);
    S size(0);
    for (std::size_t i = 0; i < q.size(); ++i) {
      for (std::size_t j = 0; j < lambda.size(); ++j) {
        moved = larger(moved, S(abs(with_mass[j][i] * lambda[j])));
        q[i] -= with_mass[j][i] * lambda[j];
      }
      size = larger(size, S(abs(q[i])));
    }
    if (moved <= 2 * std::numeric_limits<S>::epsilon() * size) break;
  }
  linearise();
  const Vector<S, dynamic> mu = multipliers(rows, with_mass, products(rows, inverse_mass_times(problem, p)));
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < mu.size(); ++j) p[i] -= rows[j][i] * mu[j];
  }
}

/// The motion on the constraints as a vector field in all of space, q' = M^-1 p, p' = -V' - g'^T lambda(q, p). No H has
/// this field as its gradient. Methods for any field (rk4, dop853, taylor) integrate it; g and g' M^-1 p drift.
/// [Sonnleitner2010, p. 22]
template <Constrained P>
class ConstrainedField {
 public:
  using Real = RealOf<P>;
  static constexpr std::size_t dimension = P::dimension;
  static_assert(QuadraticKinetic<P>, "hamflow: constraints need T = p^T M^-1 p/2 with constant M");
  explicit ConstrainedField(const P& problem) : problem_(problem) {}

  std::size_t size() const { return degrees_of_freedom(problem_); }
  template <class S, std::size_t N>
  S energy(const Vector<S, N>& q, const Vector<S, N>& p) const {
    return hamflow::energy(problem_, q, p);
  }
  /// Computes -p' and q'. A problem with constraints behind virtual calls computes this field itself.
  template <class S, std::size_t N>
  void gradient(const Vector<S, N>& q, const Vector<S, N>& p, Vector<S, N>& dq, Vector<S, N>& dp) const {
    hamflow::gradient(problem_, q, p, dq, dp);
    if constexpr (N != dynamic) {
      const Gradients<S, N> rows = constraint_gradients(problem_, q);
      Gradients<S, N> with_mass;
      for (const auto& row : rows) with_mass.push_back(inverse_mass_times(problem_, row));
      Vector<S, dynamic> right = second_derivatives_along(q, dp);
      for (std::size_t k = 0; k < right.size(); ++k) right[k] = right[k] - dot(with_mass[k], dq);
      const Vector<S, dynamic> lambda = multipliers(rows, with_mass, right);
      for (std::size_t k = 0; k < lambda.size(); ++k) {
        for (std::size_t i = 0; i < N; ++i) dq[i] = dq[i] + rows[k][i] * lambda[k];
      }
    }
  }

 private:
  /// g''(v, v), the second derivative of g along a line.
  template <class S, std::size_t N>
  Vector<S, dynamic> second_derivatives_along(const Vector<S, N>& q, const Vector<S, N>& v) const {
    using Once = Dual<S, 1>;
    using Twice = Dual<Once, 1>;
    Vector<Twice, N> line{};
    for (std::size_t i = 0; i < N; ++i) {
      line[i].value.value = q[i];
      line[i].value.slope[0] = v[i];
      line[i].slope[0].value = v[i];
    }
    const auto along = problem_.constraints(line);
    Vector<S, dynamic> all(along.size());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = along[k].slope[0].slope[0];
    return all;
  }

  P problem_;
};

}  // namespace hamflow
