// Harmonic oscillator, H = p^2/(2 m) + m omega^2 q^2/2. Many symmetric methods have a higher order on it, so it must
// not be used to measure orders. The orbit is exact: q(t) = q0 cos(omega t) + p0/(m omega) sin(omega t).
#pragma once

#include <optional>

#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/problems/linear_oscillator.hpp"
#include "hamflow/detail/problems/one_dimensional.hpp"

namespace hamflow {

template <class R = double>
class Harmonic : public OneDimensional<R> {
 public:
  explicit Harmonic(R mass = R(1), R omega = R(1)) : OneDimensional<R>(R(1) / mass), stiffness_(mass * omega * omega) {}
  explicit Harmonic(const Parameters<R>& given) : Harmonic(given["mass"], given["omega"]) {}
  /// Converts the problem from another number type.
  template <class Q>
  explicit Harmonic(const Harmonic<Q>& other)
      : OneDimensional<R>(R(other.inverse_mass())), stiffness_(R(other.stiffness_)) {}

  static ProblemInfo info() {
    return {.name = "harmonic",
            .formula = "H = p^2/(2 m) + m omega^2 q^2/2",
            .reference = "any textbook",
            .coordinates = {"q"},
            .parameters = {{"mass", "1", "mass m", Range::positive}, {"omega", "1", "angular frequency"}},
            .region = {.centre = {1.0, 0.5}, .spread = 0.2}};
  }

  template <class S>
  S potential(const Vector<S, 1>& q) const {
    return q[0] * q[0] * (stiffness_ / R(2));
  }
  template <class S>
  void force(const Vector<S, 1>& q, Vector<S, 1>& f) const {
    f[0] = -(q[0] * stiffness_);
  }
  template <class S>
  void potential_hessian(const Vector<S, 1>&, Matrix<S, 1>& out) const {
    out[0][0] = S(stiffness_);
  }

  /// The exact state at time t.
  std::optional<Start<long double, 1>> exact(const Vector<long double, 1>& q, const Vector<long double, 1>& p,
                                             long double t) const {
    const auto w = static_cast<long double>(this->inverse_mass());
    const LinearMotion x = linear_motion(q[0], p[0] * w, static_cast<long double>(stiffness_) * w, t);
    return Start<long double, 1>{{x.position}, {x.velocity / w}};
  }

 private:
  template <class>
  friend class Harmonic;
  R stiffness_;  // m omega^2
};

}  // namespace hamflow
