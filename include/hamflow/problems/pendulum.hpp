// Plane pendulum of any amplitude, H = p^2/(2 m l^2) - m g l cos q, q the angle from hanging.   [HLW2006, Sect. I.1.3]
// Libration below H = m g l, rotation above; q is not wrapped.
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"

namespace hamflow {

template <class R = double>
class Pendulum {
 public:
  using Real = R;
  static constexpr std::size_t dimension = 1;
  static constexpr bool quadratic_kinetic = true;

  explicit Pendulum(R mass = R(1), R length = R(1), R gravity = R(1))
      : inverse_inertia_(R(1) / (mass * length * length)), torque_(mass * gravity * length) {}
  explicit Pendulum(const Parameters<R>& given) : Pendulum(given["mass"], given["length"], given["gravity"]) {}

  static ProblemInfo info() {
    return {.name = "pendulum",
            .formula = "H = p^2/(2 m l^2) - m g l cos q",
            .reference = "HLW2006, Sect. I.1.3",
            .coordinates = {"q"},
            .parameters = {
                {"mass", "1", "m", Range::positive}, {"length", "1", "l", Range::positive}, {"gravity", "1", "g"}}};
  }

  template <class S>
  S kinetic(const Vector<S, 1>& p) const {
    return p[0] * p[0] * (inverse_inertia_ / R(2));
  }
  template <class S>
  S potential(const Vector<S, 1>& q) const {
    return -(cos(q[0]) * torque_);
  }
  template <class S>
  void velocity(const Vector<S, 1>& p, Vector<S, 1>& v) const {
    v[0] = p[0] * inverse_inertia_;
  }
  template <class S>
  void force(const Vector<S, 1>& q, Vector<S, 1>& f) const {
    f[0] = -(sin(q[0]) * torque_);
  }
  template <class S>
  void potential_hessian(const Vector<S, 1>& q, Matrix<S, 1>& out) const {
    out[0][0] = cos(q[0]) * torque_;
  }

 private:
  R inverse_inertia_;
  R torque_;  // m g l
};

}  // namespace hamflow
