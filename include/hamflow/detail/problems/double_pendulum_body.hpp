// The coefficients of mass matrices and potentials of a double pendulum. Massless rods of lengths 2 l_i carry masses
// m_i at their middles and inertias theta_i [Gross1999, figure 3.1, (3.52), remark 3.2]; from
//     r1 = l1 (sin q1, cos q1),   r2 = 2 l1 (sin q1, cos q1) + l2 (sin q2, cos q2)
// follow, in absolute angles,
//     M = [[a, b cos(q1 - q2)], [b cos(q1 - q2), c]],   V = -w1 cos q1 - w2 cos q2.
#pragma once

#include <string>

#include "hamflow/core/math.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/problem_info.hpp"

namespace hamflow {

template <class R>
struct DoublePendulumBody {
  R a;                  // (m1 + 4 m2) l1^2 + theta1
  R b;                  // 2 m2 l1 l2
  R c;                  // m2 l2^2 + theta2
  R least_determinant;  // a c - b^2, of the stretched pendulum, as a sum of positive terms
  R w1;                 // (m1 + 2 m2) g l1
  R w2;                 // m2 g l2

  DoublePendulumBody(const Vector<R, 2>& m, const Vector<R, 2>& l, const Vector<R, 2>& theta, R gravity)
      : a((m[0] + R(4) * m[1]) * l[0] * l[0] + theta[0]),
        b(R(2) * m[1] * l[0] * l[1]),
        c(m[1] * l[1] * l[1] + theta[1]),
        least_determinant(m[0] * l[0] * l[0] * c + R(4) * m[1] * l[0] * l[0] * theta[1] + theta[0] * c),
        w1((m[0] + R(2) * m[1]) * gravity * l[0]),
        w2(m[1] * gravity * l[1]) {}
  /// Converts the problem from another number type.
  template <class Q>
  explicit DoublePendulumBody(const DoublePendulumBody<Q>& other)
      : a(R(other.a)),
        b(R(other.b)),
        c(R(other.c)),
        least_determinant(R(other.least_determinant)),
        w1(R(other.w1)),
        w2(R(other.w2)) {}
  explicit DoublePendulumBody(const Parameters<R>& given)
      : DoublePendulumBody(two(given.list("masses")), two(given.list("half_lengths")), two(given.list("inertias")),
                           given["gravity"]) {}

  static std::vector<ParameterInfo> parameters() {
    return {{"masses", "[1, 1]", "masses m1, m2 at the middles of the rods", Range::positive, OptionType::list, 2},
            {"half_lengths", "[1, 1]", "half lengths l1, l2 of the rods", Range::positive, OptionType::list, 2},
            {"inertias", "[0, 0]", "moments of inertia theta1, theta2 of the rods about their middles",
             Range::not_negative, OptionType::list, 2},
            {"gravity", "9.81", "g"}};
  }

  /// Returns the allowed values if M is singular, else an empty text. det M > 0 for all positive masses and lengths,
  /// unless their products leave the range of R.
  std::string allowed_instead() const {
    if (least_determinant > R(0) && isfinite(least_determinant)) return {};
    return "masses, half_lengths and inertias whose mass matrix is not singular to rounding";
  }

  /// det M at q1 - q2 with the given sine.
  template <class S>
  S determinant(const S& sine) const {
    return sine * sine * (b * b) + least_determinant;
  }

 private:
  static Vector<R, 2> two(const std::vector<R>& list) { return {list.at(0), list.at(1)}; }
};

}  // namespace hamflow
