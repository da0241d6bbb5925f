// Numbers moved at random by small parts of themselves: what that makes of a sum tells its rounding from the rest.
#pragma once

#include <cstdint>

#include "hamflow/core/counter_random.hpp"
#include "hamflow/methods/implicit/equations.hpp"

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

}  // namespace hamflow::detail
