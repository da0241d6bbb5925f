// McLachlan's four stages of fourth order for quadratic T.   [McLachlan1995, SB3A, 4 stages]
// Order 4, 4 force evaluations per step, symplectic, symmetric. Closed form.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable sb3a_4{.name = "sb3a-4",
                                       .order = 4,
                                       .reference = "McLachlan1995, SB3A, 4 stages",
                                       .starts_with = StartsWith::drift,
                                       .symmetric = true,
                                       .nystroem = true,
                                       .coefficients = {"1/2-sqrt(7/8)/3", "1", "sqrt(7/8)/3-1/3", "-1/2", "2/3"}};

}  // namespace hamflow::splittings
