// Plane pendulum of any amplitude, H = p^2/(2 m l^2) - m g l cos q, q the angle from hanging.   [HLW2006, Sect. I.1.3]
// Libration below H = m g l, rotation above; q is not wrapped. With h = (q - rest)/2, w0^2 = |g|/l, the rate v = |h'|
// and the sines s = sin h, c = cos h, energy reads k^2 = s^2 + (v/w0)^2 and
//     libration, v < w0 |c|:   sin h = k sn(w0 t + u0, k),   h' = w0 k cn,
//     rotation,  v >= w0 |c|:  h = am(w0 k t + u0, 1/k),     h' = w0 k dn.                [DLMF, Sect. 22.19(i)]
#pragma once

#include <optional>

#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/numerics/elliptic.hpp"
#include "hamflow/detail/problems/one_dimensional.hpp"

namespace hamflow {

template <class R = double>
class Pendulum : public OneDimensional<R> {
 public:
  explicit Pendulum(R mass = R(1), R length = R(1), R gravity = R(1))
      : OneDimensional<R>(R(1) / (mass * length * length)), torque_(mass * gravity * length) {}
  explicit Pendulum(const Parameters<R>& given) : Pendulum(given["mass"], given["length"], given["gravity"]) {}
  /// Converts the problem from another number type.
  template <class Q>
  explicit Pendulum(const Pendulum<Q>& other) : OneDimensional<R>(R(other.inverse_mass())), torque_(R(other.torque_)) {}

  static ProblemInfo info() {
    return {.name = "pendulum",
            .variant = {{"coordinates", "generalised"}},
            .default_choices = {"coordinates"},
            .chart_key = "coordinates",
            .formula = "H = p^2/(2 m l^2) - m g l cos q",
            .reference = "HLW2006, Sect. I.1.3",
            .coordinates = {"q"},
            .angles = {"q"},
            .parameters = {{"mass", "1", "m", Range::positive},
                           {"length", "1", "l", Range::positive},
                           {"gravity", "1", "g"}},
            .region = {.centre = {2.0, 0.5}, .spread = 0.15, .time = 2.5}};
  }

  template <class S>
  S potential(const Vector<S, 1>& q) const {
    return -(cos(q[0]) * torque_);
  }
  template <class S>
  void force(const Vector<S, 1>& q, Vector<S, 1>& f) const {
    f[0] = -(sin(q[0]) * torque_);
  }
  template <class S>
  void potential_hessian(const Vector<S, 1>& q, Matrix<S, 1>& out) const {
    out[0][0] = cos(q[0]) * torque_;
  }

  /// The exact state at time t, by elliptic functions. A start on the separatrix stays there: its parameter is
  /// exactly 1.
  std::optional<Start<long double, 1>> exact(const Vector<long double, 1>& q, const Vector<long double, 1>& p,
                                             long double t) const {
    using Long = long double;
    const Long pi = pi_value<Long>();
    const auto inverse_inertia = static_cast<Long>(this->inverse_mass());
    const auto torque = static_cast<Long>(torque_);
    const Long w0 = sqrt(abs(torque) * inverse_inertia);
    // The angle from the stable equilibrium, in turns; s and c are computed from q itself, so that c is accurate near
    // the unstable equilibrium.
    const Long rest = torque < 0 ? pi : 0;
    Long turns = nearbyint((q[0] - rest) / (2 * pi));
    Long s = torque < 0 ? -cos(q[0] / 2) : sin(q[0] / 2);
    Long c = torque < 0 ? sin(q[0] / 2) : cos(q[0] / 2);
    if (detail::is_odd(turns)) {
      s = -s;
      c = -c;
    }
    if (c < 0) {  // the quotient was rounded across the unstable equilibrium
      turns += copysign(Long(1), s);
      s = -s;
      c = -c;
    }
    const Long centre = rest + 2 * pi * turns;
    // H is even in (q, p): a backward motion is the mirror image of a forward motion.
    const Long direction = p[0] < 0 ? -1 : 1;
    s *= direction;
    const Long v = abs(p[0]) * inverse_inertia / 2;
    const Long rate = hypot(v, w0 * s);  // w0 k
    if (rate == 0 || (v == 0 && w0 * c == 0)) return Start<Long, 1>{q, p};
    if (v < w0 * c) {
      const Long k = rate / w0;
      const Long m1 = (c - v / w0) * (c + v / w0);
      const Jacobi<Long> j = jacobi_of_complement(w0 * t + incomplete_f_of_complement(s / k, v / rate, m1), m1);
      return Start<Long, 1>{{centre + direction * 2 * atan2(k * j.sn, j.dn)},
                            {direction * 2 * rate * j.cn / inverse_inertia}};
    }
    const Long m1 = (v - w0 * c) / rate * ((v + w0 * c) / rate);
    const Jacobi<Long> j = jacobi_of_complement(rate * t + incomplete_f_of_complement(s, c, m1), m1);
    return Start<Long, 1>{{centre + direction * 2 * j.am}, {direction * 2 * rate * j.dn / inverse_inertia}};
  }

 private:
  template <class>
  friend class Pendulum;
  R torque_;  // m g l
};

}  // namespace hamflow
