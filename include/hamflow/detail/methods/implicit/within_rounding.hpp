// Numbers moved at random by small parts of themselves: what that makes of a sum tells its rounding from the rest.
#pragma once

#include <cstdint>

#include "hamflow/core/counter_random.hpp"
#include "hamflow/detail/methods/implicit/equations.hpp"

namespace hamflow::detail {

/// How often a sum is asked.
inline constexpr std::uint64_t rounding_draws = 8;

/// y moved by one or two units, up or down.
/// @param unit relative   @param draw which of the draws   @param i which of the numbers that are moved in it
template <class Real>
Real moved_by(const Real& unit, const Real& y, std::uint64_t draw, std::uint64_t i) {
  static constexpr int units[] = {-2, -1, 1, 2};
  return y + Real(units[counter_bits(draw, i) & 3]) * unit * y;
}

/// Within its rounding.
template <class Real>
Real within_rounding(const Real& y, std::uint64_t draw, std::uint64_t i) {
  return moved_by(Real(Epsilon<Real>{} * Real(1)), y, draw, i);
}

/// The largest of eight second differences that rounding makes, found by what tells it from the rest: it is as large
/// for moves 16 times as large, up to a factor of 8, and at both sizes some draw differs from the first by an eighth of
/// the larger one. (Not by more: the point that all are differences from rounds as well.) 0 where that is not seen.
/// @param second(part, draw): a vector of second differences, under moves by such a part
template <class Real, class Second>
Real plateau_of_rounding(const Second& second) {
  Real part = Real(1) / Real(1 << 26);
  Real smaller(0);  // under moves 16 times smaller, where it is rounding's
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
