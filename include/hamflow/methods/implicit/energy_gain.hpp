// What one more Gauss point sees of the energy that a step gains: how quadrature = "auto" judges.
#pragma once

#include "hamflow/methods/implicit/equations.hpp"

namespace hamflow::detail {

/// The rounding of a sum of work, that of its terms and that of the coordinates at which forces are evaluated, which
/// adds up as independent roundings do.
template <class Real>
struct RoundingOfWork {
  Real works{0};
  Real bends{0};
  /// @param bend (V'' d) q: the change of a force along the step times the coordinate
  void add(const Real& work, const Real& bend) {
    works += work * work;
    bends += bend * bend;
  }
  Real of_terms(int terms) const {
    constexpr auto epsilon = Epsilon<Real>{};
    return epsilon * Real(Real(terms) * sqrt(works) + Real(4) * sqrt(bends));
  }
};

/// What points see of the energy that a step gains, and what rounding makes of it.
template <class Real>
struct Gain {
  Real gain{0};
  Real size{0};   // of its terms
  Real noise{0};  // that rounding explains
};

/// Whether a step gains energy that is no rounding: one more point sees more than rounding explains, and two more see
/// the same. Where the estimate of rounding is too small, they see different noise.
/// @param two_more(): the gain as two more points see it   @param has_two whether there are so many
template <class Real, class TwoMore>
bool gains_energy(const Gain<Real>& one, bool has_two, const TwoMore& two_more) {
  if (abs(one.gain) <= one.noise) return false;
  if (abs(one.gain) > Real(4096) * one.noise || !has_two) return true;
  return abs(two_more() - one.gain) <= abs(one.gain) / 2;
}

}  // namespace hamflow::detail
