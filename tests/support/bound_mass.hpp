// A mass point on a sphere and two on rods, as a user would write problems with constraints.
#pragma once

#include "hamflow/core/constraints.hpp"

namespace hamflow::test {

/// |q|^2 = 1 in the plane or in space, the last axis up.
template <class R, std::size_t n>
struct OnSphere {
  using Real = R;
  static constexpr std::size_t dimension = n;
  static constexpr bool quadratic_kinetic = true;
  template <class S>
  S kinetic(const Vector<S, n>& p) const {
    return dot(p, p) / R(2);
  }
  template <class S>
  S potential(const Vector<S, n>& q) const {
    return q[n - 1] * R(1);
  }
  template <class S>
  Vector<S, 1> constraints(const Vector<S, n>& q) const {
    return {dot(q, q) - R(1)};
  }
};
template <class R>
using OnCircle = OnSphere<R, 2>;

/// The double pendulum with m1 = 1, m2 = 2, l1 = 1, l2 = 3/4, g = 5.
template <class R>
struct OnRods {
  using Real = R;
  static constexpr std::size_t dimension = 4;
  static constexpr bool quadratic_kinetic = true;
  template <class S>
  S kinetic(const Vector<S, 4>& p) const {
    return (p[0] * p[0] + p[1] * p[1]) / R(2) + (p[2] * p[2] + p[3] * p[3]) / R(4);
  }
  template <class S>
  S potential(const Vector<S, 4>& q) const {
    return (q[1] + R(2) * q[3]) * R(5);
  }
  template <class S>
  Vector<S, 2> constraints(const Vector<S, 4>& q) const {
    const S x = q[2] - R(2) * q[0];
    const S y = q[3] - R(2) * q[1];
    return {q[0] * q[0] + q[1] * q[1] - R(1), x * x + y * y - R(9) / R(16)};
  }
};
struct RodAngles {
  static constexpr std::size_t dimension = 2;
  static constexpr std::size_t space = 4;
  template <class S>
  Vector<S, 4> operator()(const Vector<S, 2>& q) const {
    const S x = sin(q[0]);
    const S y = -cos(q[0]);
    return {x, y, 2.0 * x + sin(q[1]) * 0.75, 2.0 * y - cos(q[1]) * 0.75};
  }
};

}  // namespace hamflow::test
