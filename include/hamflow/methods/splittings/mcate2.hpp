// McLachlan's and Atela's optimal second order.   [McLachlanAtela1992, order 2]
// Order 2, 2 force evaluations per step, symplectic. Closed form.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable mcate2{.name = "mcate2",
                                       .order = 2,
                                       .reference = "McLachlanAtela1992, order 2",
                                       .starts_with = StartsWith::kick,
                                       .coefficients = {"1-sqrt(1/2)", "sqrt(1/2)", "sqrt(1/2)", "1-sqrt(1/2)"}};

}  // namespace hamflow::splittings
