// Small random relative changes of numbers. Their effect on a sum distinguishes rounding from a smooth dependence.
#pragma once

#include <cstdint>

#include "hamflow/core/counter_random.hpp"
#include "hamflow/detail/methods/implicit/equations.hpp"

namespace hamflow::detail {

/// The number of random draws.
inline constexpr std::uint64_t rounding_draws = 8;

/// y changed by one or two units, up or down.
/// @param unit relative unit @param draw index of the draw @param i index of the number
template <class Real>
Real moved_by(const Real& unit, const Real& y, std::uint64_t draw, std::uint64_t i) {
  static constexpr int units[] = {-2, -1, 1, 2};
  return y + Real(units[counter_bits(draw, i) & 3]) * unit * y;
}

/// y changed within its rounding.
template <class Real>
Real within_rounding(const Real& y, std::uint64_t draw, std::uint64_t i) {
  return moved_by(Real(Epsilon<Real>{} * Real(1)), y, draw, i);
}

/// The largest of eight second differences, if they are due to rounding: they are equal, up to a factor of 8, for
/// changes 16 times as large, and at both sizes some draw differs from the first by an eighth of the larger one. (Not
/// by more, because the common base point has a rounding error, too.) Otherwise 0.
/// @param second(part, draw) returns the second differences for relative changes by `part`
template <class Real, class Second>
Real plateau_of_rounding(const Second& second) {
  Real part = Real(1) / Real(1 << 26);
  Real smaller(0);  // for changes 16 times smaller, if due to rounding
  for (int scale = 0; scale < 5; ++scale) {
    const auto first = second(part, 0);
    Real most = max_norm(first);
    bool differs = false;
    for (std::uint64_t draw = 1; draw < rounding_draws; ++draw) {
      const auto other = second(part, draw);
      Real apart(0);
      for (std::size_t i = 0; i < other.size(); ++i) apart = larger(apart, Real(abs(other[i] - first[i])));
      const Real size = max_norm(other);
      differs = differs || Real(8) * apart >= larger(size, max_norm(first));
      most = larger(most, size);
    }
    differs = differs && most > Real(0);
    if (differs && smaller > Real(0) && most <= Real(8) * smaller) return smaller;
    smaller = differs ? most : Real(0);
    part = Real(16) * part;
  }
  return Real(0);
}

}  // namespace hamflow::detail
