// Ruth's third order.   [Ruth1983]
// Order 3, 3 force evaluations per step, symplectic. Exact.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable ruth3{.name = "ruth3",
                                      .order = 3,
                                      .reference = "Ruth1983",
                                      .starts_with = StartsWith::kick,
                                      .coefficients = {"7/24", "2/3", "3/4", "-2/3", "-1/24", "1"}};

}  // namespace hamflow::splittings
