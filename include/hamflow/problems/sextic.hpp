// A polynomial example that is not symmetric in p, H = p^3/3 - p/2 + q^6/30 + q^4/4 - q^3/3 + 1/6.
// [FaouHairerPham2004]   Separable, but its kinetic energy is not quadratic: reversing p does not reverse time,
// and symmetric methods that are not symplectic may drift in energy. Motion near p = 1/sqrt 2, q^3/5 + q = 1, where T
// and V have their minima, is bounded.
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"

namespace hamflow {

template <class R = double>
class Sextic {
 public:
  using Real = R;
  static constexpr std::size_t dimension = 1;
  static constexpr bool quadratic_kinetic = false;

  Sextic() = default;
  explicit Sextic(const Parameters<R>&) {}

  static ProblemInfo info() {
    return {.name = "sextic",
            .formula = "H = p^3/3 - p/2 + q^6/30 + q^4/4 - q^3/3 + 1/6",
            .reference = "FaouHairerPham2004",
            .coordinates = {"q"},
            .region = {.centre = {0.6, 0.9}, .spread = 0.2, .step = 0.023}};
  }

  template <class S>
  S kinetic(const Vector<S, 1>& p) const {
    return (p[0] * p[0] / R(3) - R(1) / R(2)) * p[0];
  }
  template <class S>
  S potential(const Vector<S, 1>& q) const {
    const S q2 = q[0] * q[0];
    const S q3 = q2 * q[0];  // named, because compilers evaluate factors in any order, and slopes depend on it
    return ((q2 / R(30) + R(1) / R(4)) * q[0] - R(1) / R(3)) * q3 + R(1) / R(6);
  }
  template <class S>
  void velocity(const Vector<S, 1>& p, Vector<S, 1>& v) const {
    v[0] = p[0] * p[0] - R(1) / R(2);
  }
  /// -V' = q^2 - q^3 - q^5/5.
  template <class S>
  void force(const Vector<S, 1>& q, Vector<S, 1>& f) const {
    const S q2 = q[0] * q[0];
    f[0] = q2 * (R(1) - q[0] * (R(1) + q2 / R(5)));
  }
  /// V'' = q^4 + 3 q^2 - 2 q.
  template <class S>
  void potential_hessian(const Vector<S, 1>& q, Matrix<S, 1>& out) const {
    out[0][0] = ((q[0] * q[0] + R(3)) * q[0] - R(2)) * q[0];
  }
};

}  // namespace hamflow
