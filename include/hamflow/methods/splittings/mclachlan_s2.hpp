// McLachlan's second order with the smallest error constant of two stages.   [McLachlan1995, S, 2 stages]
// Order 2, 2 force evaluations per step, symplectic, symmetric. Closed form.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable mclachlan_s2{
    .name = "mclachlan-s2",
    .order = 2,
    .reference = "McLachlan1995, S, 2 stages",
    .starts_with = StartsWith::kick,
    .symmetric = true,
    .coefficients = {"1/2-(36+2*sqrt(326))^(1/3)/12+1/(6*(36+2*sqrt(326))^(1/3))", "1/2",
                     "(36+2*sqrt(326))^(1/3)/6-1/(3*(36+2*sqrt(326))^(1/3))"}};

}  // namespace hamflow::splittings
