// The kinetic energy of one degree of freedom with constant mass, T = p^2/(2 m).
#pragma once

#include "hamflow/core/derivatives.hpp"

namespace hamflow {

/// The base of a problem H = p^2/(2 m) + V(q), which adds potential and force.
template <class R>
class OneDimensional {
 public:
  using Real = R;
  static constexpr std::size_t dimension = 1;
  static constexpr bool quadratic_kinetic = true;

  template <class S>
  S kinetic(const Vector<S, 1>& p) const {
    return p[0] * p[0] * (inverse_mass_ / R(2));
  }
  template <class S>
  void velocity(const Vector<S, 1>& p, Vector<S, 1>& v) const {
    v[0] = p[0] * inverse_mass_;
  }

 protected:
  /// @param inverse_mass 1/m; of an angle, the inverse of the moment of inertia
  explicit OneDimensional(R inverse_mass) : inverse_mass_(inverse_mass) {}
  const R& inverse_mass() const { return inverse_mass_; }

 private:
  R inverse_mass_;
};

}  // namespace hamflow
