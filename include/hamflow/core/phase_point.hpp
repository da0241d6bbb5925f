// A state z = (q, p) as it is stored, with the arithmetic that stores it.
#pragma once

#include "hamflow/core/concepts.hpp"

namespace hamflow {

template <Arithmetic A, std::size_t N>
struct PhasePoint {
  using Real = typename A::Real;
  using Stored = typename A::Stored;

  Vector<Stored, N> q{};
  Vector<Stored, N> p{};
  [[no_unique_address]] A arithmetic{};

  void store(const Vector<Real, N>& q_values, const Vector<Real, N>& p_values) {
    q = zeros<Stored, N>(q_values.size());
    p = zeros<Stored, N>(p_values.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] = arithmetic.position.store(q_values[i]);
      p[i] = arithmetic.momentum.store(p_values[i]);
    }
  }
  /// The positions as numbers; a reference if they are stored as numbers in a vector of any size.
  decltype(auto) positions() const {
    if constexpr (N == dynamic && std::is_same_v<Stored, Real>) {
      return static_cast<const Vector<Real, N>&>(q);
    } else {
      Vector<Real, N> x = zeros<Real, N>(q.size());
      for (std::size_t i = 0; i < q.size(); ++i) x[i] = arithmetic.position.read(q[i]);
      return x;
    }
  }
  /// The momenta as numbers, or a reference as for positions().
  decltype(auto) momenta() const {
    if constexpr (N == dynamic && std::is_same_v<Stored, Real>) {
      return static_cast<const Vector<Real, N>&>(p);
    } else {
      Vector<Real, N> x = zeros<Real, N>(p.size());
      for (std::size_t i = 0; i < p.size(); ++i) x[i] = arithmetic.momentum.read(p[i]);
      return x;
    }
  }
  /// q <- q + increment.
  void move(const Vector<Real, N>& increment) {
    for (std::size_t i = 0; i < q.size(); ++i) arithmetic.position.add(q[i], increment[i]);
  }
  /// p <- p + increment.
  void push(const Vector<Real, N>& increment) {
    for (std::size_t i = 0; i < p.size(); ++i) arithmetic.momentum.add(p[i], increment[i]);
  }
  /// p <- p + increment, in lattice units.
  void push(const Vector<Stored, N>& units) requires IntegerSums<A> {
    for (std::size_t i = 0; i < p.size(); ++i) arithmetic.momentum.add_units(p[i], units[i]);
  }
  /// q <- q + factor * direction (a drift, for direction = dT/dp).
  template <class F>
  void move(const F& factor, const Vector<Real, N>& direction) {
    for (std::size_t i = 0; i < q.size(); ++i) arithmetic.position.add(q[i], factor * direction[i]);
  }
  /// p <- p + factor * direction (a kick, for direction = -dV/dq).
  template <class F>
  void push(const F& factor, const Vector<Real, N>& direction) {
    for (std::size_t i = 0; i < p.size(); ++i) arithmetic.momentum.add(p[i], factor * direction[i]);
  }
  /// S z: reverses the momenta.
  void negate_momenta() {
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = A::Axis::negated(p[i]);
  }
  template <class Archive>
  void archive(Archive& ar) {
    ar(q, p, arithmetic.position, arithmetic.momentum);
  }
};

}  // namespace hamflow
