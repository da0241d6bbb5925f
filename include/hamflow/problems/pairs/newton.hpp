// Newtonian pairs, phi(r) = -1/sqrt(r^2 + softening^2).   [HLW2006, (I.2.11)]
#pragma once

#include "hamflow/core/problem_info.hpp"

namespace hamflow::pairs {

template <class R>
class Newton {
 public:
  explicit Newton(const Parameters<R>& given) : softening_squared_(given["softening"] * given["softening"]) {}
  static ProblemInfo info() {
    return {.name = "newton",
            .formula = "phi(r) = -1/sqrt(r^2 + softening^2)",
            .reference = "HLW2006, (I.2.11)",
            .parameters = {{"softening", "0", "length", Range::not_negative}}};
  }

  // strength phi, and the factor c of the force -c (x_i - x_j) on body i, for d = r^2 + softening^2.
  template <class T, class S>
  static S energy(const T& strength, const S& d) {
    return -strength / sqrt(d);
  }
  template <class T, class S>
  static S pull(const T& strength, const S& d) {
    return strength / (d * sqrt(d));
  }

  /// phi as a function of u = r^2, and its derivatives by u.
  template <class S>
  S value(const S& u) const {
    return energy(R(1), S(u + softening_squared_));
  }
  template <class S>
  S first(const S& u) const {
    return pull(R(0.5), S(u + softening_squared_));
  }
  template <class S>
  S second(const S& u) const {
    const S d = u + softening_squared_;
    return R(-0.75) / (d * d * sqrt(d));
  }
  const R& softening_squared() const { return softening_squared_; }

 private:
  R softening_squared_;
};

}  // namespace hamflow::pairs
