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
    for (std::size_t i = 0; i < N; ++i) {
      q[i] = arithmetic.position.store(q_values[i]);
      p[i] = arithmetic.momentum.store(p_values[i]);
    }
  }
  Vector<Real, N> positions() const {
    Vector<Real, N> x{};
    for (std::size_t i = 0; i < N; ++i) x[i] = arithmetic.position.read(q[i]);
    return x;
  }
  Vector<Real, N> momenta() const {
    Vector<Real, N> x{};
    for (std::size_t i = 0; i < N; ++i) x[i] = arithmetic.momentum.read(p[i]);
    return x;
  }
  /// q <- q + factor * direction (a drift, for direction = dT/dp).
  template <class F>
  void move(const F& factor, const Vector<Real, N>& direction) {
    for (std::size_t i = 0; i < N; ++i) arithmetic.position.add(q[i], factor * direction[i]);
  }
  /// p <- p + factor * direction (a kick, for direction = -dV/dq).
  template <class F>
  void push(const F& factor, const Vector<Real, N>& direction) {
    for (std::size_t i = 0; i < N; ++i) arithmetic.momentum.add(p[i], factor * direction[i]);
  }
  /// S z: the state with its momenta reversed.
  void negate_momenta() {
    for (std::size_t i = 0; i < N; ++i) p[i] = A::Axis::negated(p[i]);
  }
};

}  // namespace hamflow
