// Free fall in a uniform field, H = p^2/(2 m) + m g q, q the height.   [Sonnleitner2010, p. 17]
// The force is constant: Verlet and every method of order 2 are exact, so that only their rounding remains.
#pragma once

#include <optional>

#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/problems/one_dimensional.hpp"

namespace hamflow {

template <class R = double>
class FreeFall : public OneDimensional<R> {
 public:
  explicit FreeFall(R mass = R(1), R gravity = R(1)) : OneDimensional<R>(R(1) / mass), weight_(mass * gravity) {}
  explicit FreeFall(const Parameters<R>& given) : FreeFall(given["mass"], given["gravity"]) {}
  /// Converts the problem from another number type.
  template <class Q>
  explicit FreeFall(const FreeFall<Q>& other) : OneDimensional<R>(R(other.inverse_mass())), weight_(R(other.weight_)) {}

  static ProblemInfo info() {
    return {.name = "free-fall",
            .formula = "H = p^2/(2 m) + m g q",
            .reference = "Sonnleitner2010, p. 17",
            .coordinates = {"q"},
            .parameters = {{"mass", "1", "mass m", Range::positive}, {"gravity", "1", "acceleration g"}},
            // An unbounded fall: a short time, in which H does not become a difference of large numbers.
            .region = {.centre = {0.5, 0.5}, .step = 0.0002, .time = 1}};
  }

  template <class S>
  S potential(const Vector<S, 1>& q) const {
    return q[0] * weight_;
  }
  template <class S>
  void force(const Vector<S, 1>&, Vector<S, 1>& f) const {
    f[0] = S(-weight_);
  }
  template <class S>
  void potential_hessian(const Vector<S, 1>&, Matrix<S, 1>& out) const {
    out[0][0] = S(R(0));
  }

  /// The exact state at time t.
  std::optional<Start<long double, 1>> exact(const Vector<long double, 1>& q, const Vector<long double, 1>& p,
                                             long double t) const {
    const auto w = static_cast<long double>(this->inverse_mass());
    const auto weight = static_cast<long double>(weight_);
    return Start<long double, 1>{{q[0] + t * w * (p[0] - weight * t / 2)}, {p[0] - weight * t}};
  }

 private:
  template <class>
  friend class FreeFall;
  R weight_;  // m g
};

}  // namespace hamflow
