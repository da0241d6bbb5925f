// A charged particle in a uniform magnetic field, H = |p - e A(x)|^2/(2 m), A = B x x/2.   [Jackson1998, Sect. 12.3]
// The orbit is a helix about the field with the cyclotron frequency e |B|/m. p is the canonical momentum m v + e A(x).
// H(q, -p) differs from H(q, p): reversing the momenta does not reverse the motion unless the field is reversed too
// [Sonnleitner2010, footnote 21].
#pragma once

#include <optional>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"

namespace hamflow {

template <class R = double>
class Magnetic {
  // First, because its return type is deduced.
  template <class S, class T>
  static auto cross(const Vector<S, 3>& a, const Vector<T, 3>& b) {
    using U = decltype(a[0] * b[0]);
    return Vector<U, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }

 public:
  using Real = R;
  static constexpr std::size_t dimension = 3;

  /// @param strength charge times field
  Magnetic(R mass, Vector<R, 3> strength) : mass_(mass), strength_(strength) {}
  /// Converts the problem from another number type.
  template <class Q>
  explicit Magnetic(const Magnetic<Q>& other)
      : Magnetic(R(other.mass_), {R(other.strength_[0]), R(other.strength_[1]), R(other.strength_[2])}) {}
  explicit Magnetic(const Parameters<R>& given)
      : Magnetic(given["mass"], {given["charge"] * given.list("field")[0], given["charge"] * given.list("field")[1],
                                 given["charge"] * given.list("field")[2]}) {}

  static ProblemInfo info() {
    return {
        .name = "magnetic",
        .formula = "H = |p - e A(x)|^2/(2 m), A = B x x/2",
        .reference = "Sonnleitner2010, footnote 21",
        .coordinates = {"x", "y", "z"},
        .parameters = {{"mass", "1", "m", Range::positive},
                       {"charge", "1", "e"},
                       {.name = "field",
                        .default_value = "[0, 0, 1]",
                        .meaning = "uniform magnetic field B",
                        .type = OptionType::list,
                        .length = 3}},
        .invariants = {{"angular_momentum", "e B.(x x p)/(e |B|): the component along the field; without one, along z",
                        Components::one, Terms::moments},
                       {"parallel_momentum", "e B.p/(e |B|)", Components::one, Terms::momenta}},
        .region = {.centre = {0.4, -0.3, 0.2, 0.5, 0.3, 0.4}}};
  }

  template <class S>
  S energy(const Vector<S, 3>& q, const Vector<S, 3>& p) const {
    Vector<S, 3> v{};
    velocity_of(q, p, v);
    return (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * (mass_ / R(2));
  }
  /// dH/dp = v, dH/dq = -(e/2) v x B.
  template <class S>
  void gradient(const Vector<S, 3>& q, const Vector<S, 3>& p, Vector<S, 3>& dq, Vector<S, 3>& dp) const {
    velocity_of(q, p, dp);
    const Vector<S, 3> turn = cross(dp, strength_);
    for (std::size_t i = 0; i < 3; ++i) dq[i] = turn[i] * R(-0.5);
  }
  /// Constant: v = (p - C q)/m with C q = (e/2) B x q.
  template <class S>
  void hessian(const Vector<S, 3>&, const Vector<S, 3>&, Matrix<S, 3>& qq, Matrix<S, 3>& qp, Matrix<S, 3>& pp) const {
    const Vector<R, 3> b{strength_[0] / R(2), strength_[1] / R(2), strength_[2] / R(2)};
    const R c[3][3] = {{R(0), -b[2], b[1]}, {b[2], R(0), -b[0]}, {-b[1], b[0], R(0)}};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        R sum(0);
        for (std::size_t k = 0; k < 3; ++k) sum += c[k][i] * c[k][j];
        qq[i][j] = sum / mass_;
        qp[i][j] = -c[j][i] / mass_;
        pp[i][j] = i == j ? R(1) / mass_ : R(0);
      }
    }
  }
  template <class S>
  Vector<S, 2> invariants(const Vector<S, 3>& q, const Vector<S, 3>& p, const S& /*t*/) const {
    const R size = sqrt(strength_[0] * strength_[0] + strength_[1] * strength_[1] + strength_[2] * strength_[2]);
    const Vector<S, 3> l = cross(q, p);
    if (!(size > R(0))) return {l[2], p[2]};
    const Vector<R, 3> b{strength_[0] / size, strength_[1] / size, strength_[2] / size};
    return {l[0] * b[0] + l[1] * b[1] + l[2] * b[2], p[0] * b[0] + p[1] * b[1] + p[2] * b[2]};
  }

  // Functions for boris.
  /// v = (p - (e/2) B x q)/m.
  template <class S>
  void velocity_of(const Vector<S, 3>& q, const Vector<S, 3>& p, Vector<S, 3>& v) const {
    const Vector<S, 3> a = cross(strength_, q);
    for (std::size_t i = 0; i < 3; ++i) v[i] = (p[i] - a[i] * R(0.5)) / mass_;
  }
  /// p = m v + (e/2) B x q.
  template <class S>
  void momentum_of(const Vector<S, 3>& q, const Vector<S, 3>& v, Vector<S, 3>& p) const {
    const Vector<S, 3> a = cross(strength_, q);
    for (std::size_t i = 0; i < 3; ++i) p[i] = v[i] * mass_ + a[i] * R(0.5);
  }
  /// e B/m: v' = v x rotation.
  Vector<R, 3> rotation() const { return {strength_[0] / mass_, strength_[1] / mass_, strength_[2] / mass_}; }

  /// The helix: the velocity rotates about the field at the rate |e B/m|; the position follows by integration.
  std::optional<Start<long double, 3>> exact(const Vector<long double, 3>& q, const Vector<long double, 3>& p,
                                             long double t) const {
    using L = long double;
    const Magnetic<L> exactly(static_cast<L>(mass_), cast<L>(strength_));
    Vector<L, 3> v{};
    exactly.velocity_of(q, p, v);
    const Vector<L, 3> omega = exactly.rotation();
    const L rate = sqrt(omega[0] * omega[0] + omega[1] * omega[1] + omega[2] * omega[2]);
    Start<L, 3> end{q, p};
    if (!(rate > 0)) {
      for (std::size_t i = 0; i < 3; ++i) end.q[i] += v[i] * t;
      return end;
    }
    const Vector<L, 3> axis{omega[0] / rate, omega[1] / rate, omega[2] / rate};
    const L along = v[0] * axis[0] + v[1] * axis[1] + v[2] * axis[2];
    const Vector<L, 3> turned = exactly.cross(v, axis);  // v x axis: the direction in which the velocity rotates
    const L angle = rate * t;
    const L s = sin(angle);
    const L half = sin(angle / 2);
    Vector<L, 3> v_t{};
    for (std::size_t i = 0; i < 3; ++i) {
      const L across = v[i] - along * axis[i];
      v_t[i] = along * axis[i] + across * cos(angle) + turned[i] * s;
      end.q[i] += along * axis[i] * t + (across * s + turned[i] * 2 * half * half) / rate;
    }
    exactly.momentum_of(end.q, v_t, end.p);
    return end;
  }

 private:
  template <class>
  friend class Magnetic;
  R mass_;
  Vector<R, 3> strength_;
};

}  // namespace hamflow
