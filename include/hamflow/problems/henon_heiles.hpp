// Henon-Heiles, H = (p1^2 + p2^2 + q1^2 + q2^2)/2 + lambda (q1^2 q2 - q2^3/3).   [HLW2006, Sect. I.3.4 (lambda = 1)]
// Bounded motion for 0 <= H < 1/(6 lambda^2) inside the triangle through (0, 1/lambda); regular for small H, chaotic
// above about 1/(8 lambda^2). H is cubic in q: two Gauss points integrate its force exactly along a straight segment.
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"

namespace hamflow {

template <class R = double>
class HenonHeiles {
 public:
  using Real = R;
  static constexpr std::size_t dimension = 2;
  static constexpr bool quadratic_kinetic = true;

  explicit HenonHeiles(R lambda = R(1)) : lambda_(lambda) {}
  explicit HenonHeiles(const Parameters<R>& given) : HenonHeiles(given["lambda"]) {}

  static ProblemInfo info() {
    return {.name = "henon-heiles",
            .formula = "H = (p1^2 + p2^2 + q1^2 + q2^2)/2 + lambda (q1^2 q2 - q2^3/3)",
            .reference = "HLW2006, Sect. I.3.4",
            .coordinates = {"q1", "q2"},
            .parameters = {{"lambda", "1", "strength of the cubic terms"}},
            .region = {.centre = {0.3, -0.15, 0.2, 0.25}, .spread = 0.08, .time = 3.25}};
  }

  template <class S>
  S kinetic(const Vector<S, 2>& p) const {
    return (p[0] * p[0] + p[1] * p[1]) / R(2);
  }
  template <class S>
  S potential(const Vector<S, 2>& q) const {
    return (q[0] * q[0] + q[1] * q[1]) / R(2) + (q[0] * q[0] - q[1] * q[1] / R(3)) * q[1] * lambda_;
  }
  template <class S>
  void velocity(const Vector<S, 2>& p, Vector<S, 2>& v) const {
    v = p;
  }
  template <class S>
  void force(const Vector<S, 2>& q, Vector<S, 2>& f) const {
    f[0] = -q[0] - R(2) * lambda_ * q[0] * q[1];
    f[1] = -q[1] - lambda_ * (q[0] * q[0] - q[1] * q[1]);
  }
  template <class S>
  void potential_hessian(const Vector<S, 2>& q, Matrix<S, 2>& out) const {
    out[0][0] = R(1) + R(2) * lambda_ * q[1];
    out[0][1] = out[1][0] = R(2) * lambda_ * q[0];
    out[1][1] = R(1) - R(2) * lambda_ * q[1];
  }

 private:
  R lambda_;
};

}  // namespace hamflow
