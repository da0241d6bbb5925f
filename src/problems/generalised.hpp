// Generalised coordinates Q of a constrained motion. They follow from the parametrisation q = G(Q) of the manifold by
// differentiation:   [HLW2006, Sect. VII.1.2; Sonnleitner2010, p. 24, whose formula for p lacks M]
//     P = G'^T p,   p = M G' A^-1 P,   A = G'^T M G',   H(Q, P) = P^T A^-1 P/2 + V(G(Q)).
//
// `Map` is a class with the numbers of generalised and Cartesian coordinates and G for any number type:
//     struct Circle {
//       static constexpr std::size_t dimension = 1, space = 2;
//       template <class S>
//       Vector<S, 2> operator()(const Vector<S, 1>& q) const { return {sin(q[0]), -cos(q[0])}; }
//     };
#pragma once

#include "hamflow/core/constraints.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/numerics/dense.hpp"

namespace hamflow {

/// dG/dQ_j for each j, as vectors of Cartesian coordinates.
template <class Map, class S>
Gradients<S, Map::space> tangents_of(const Map& map, const Vector<S, Map::dimension>& q) {
  constexpr std::size_t k = Map::dimension;
  Vector<Dual<S, k>, k> seeded{};
  for (std::size_t j = 0; j < k; ++j) seeded[j] = Dual<S, k>::variable(q[j], j);
  const Vector<Dual<S, k>, Map::space> at = map(seeded);
  Gradients<S, Map::space> all(k, zeros<S, Map::space>(Map::space));
  for (std::size_t j = 0; j < k; ++j) {
    for (std::size_t i = 0; i < Map::space; ++i) all[j][i] = at[i].slope[j];
  }
  return all;
}

namespace detail {
template <class S, class R, std::size_t N>
Gradients<S, N> with_matrix(const Matrix<R, N>& m, const Gradients<S, N>& vectors) {
  Gradients<S, N> all;
  for (const Vector<S, N>& x : vectors) {
    Vector<S, N> y = x;
    for (std::size_t i = 0; i < N; ++i) {
      y[i] = x[0] * m[i][0];
      for (std::size_t j = 1; j < N; ++j) y[i] = y[i] + x[j] * m[i][j];
    }
    all.push_back(y);
  }
  return all;
}
template <class S, std::size_t N>
Vector<S, dynamic> listed(const Vector<S, N>& x) {
  Vector<S, dynamic> all(N);
  for (std::size_t i = 0; i < N; ++i) all[i] = x[i];
  return all;
}
}  // namespace detail

/// The Cartesian state of a generalised state. @param mass M
template <class Map, class R, class S>
Start<S, Map::space> cartesian_state(const Map& map, const Matrix<R, Map::space>& mass,
                                     const Start<S, Map::dimension>& state) {
  const auto tangents = tangents_of(map, state.q);
  const auto with_mass = detail::with_matrix(mass, tangents);
  const auto rates = multipliers(tangents, with_mass, detail::listed(state.p));
  Start<S, Map::space> there{map(state.q), {}};
  for (std::size_t i = 0; i < Map::space; ++i) {
    there.p[i] = with_mass[0][i] * rates[0];
    for (std::size_t j = 1; j < Map::dimension; ++j) there.p[i] = there.p[i] + with_mass[j][i] * rates[j];
  }
  return there;
}
/// P from Cartesian momenta at G(Q).
template <class Map, class S>
Vector<S, Map::dimension> generalised_momenta(const Map& map, const Vector<S, Map::dimension>& q,
                                              const Vector<S, Map::space>& p) {
  const auto tangents = tangents_of(map, q);
  Vector<S, Map::dimension> all{};
  for (std::size_t j = 0; j < Map::dimension; ++j) all[j] = dot(tangents[j], p);
  return all;
}

/// The motion of a problem p^T M^-1 p/2 + V(q) on the manifold, as a problem without constraints.
template <class P, class Map>
class Generalised {
 public:
  using Real = RealOf<P>;
  static constexpr std::size_t dimension = Map::dimension;
  static_assert(QuadraticKinetic<P>, "hamflow: generalised coordinates need T = p^T M^-1 p/2 with constant M");
  static_assert(P::dimension == Map::space, "hamflow: G must have as many values as the problem has coordinates");

  Generalised(const P& problem, const Map& map)
      : problem_(problem), map_(map), mass_(inverse(inverse_mass_matrix(problem))) {}

  template <class S>
  S energy(const Vector<S, dimension>& q, const Vector<S, dimension>& p) const {
    const auto tangents = tangents_of(map_, q);
    const auto momenta = detail::listed(p);
    const auto rates = multipliers(tangents, detail::with_matrix(mass_, tangents), momenta);
    return dot(momenta, rates) / Real(2) + problem_.potential(map_(q));
  }
  /// Converts a generalised state to Cartesian coordinates and back; back needs Q.
  template <class S>
  Start<S, Map::space> to_cartesian(const Start<S, dimension>& state) const {
    return cartesian_state(map_, mass_, state);
  }
  template <class S>
  Vector<S, dimension> momenta(const Vector<S, dimension>& q, const Vector<S, Map::space>& p) const {
    return generalised_momenta(map_, q, p);
  }

 private:
  P problem_;
  Map map_;
  Matrix<Real, Map::space> mass_;
};

}  // namespace hamflow
