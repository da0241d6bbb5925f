// McLachlan's four stages of fourth order.   [McLachlan1995, S, 4 stages]
// Order 4, 4 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable mclachlan_s4{.name = "mclachlan-s4",
                                             .order = 4,
                                             .reference = "McLachlan1995, S, 4 stages",
                                             .starts_with = StartsWith::kick,
                                             .symmetric = true,
                                             .coefficients = {"0.1691392799220720451750024659651743352139", "6/11",
                                                              "-0.2991862039040507995086317151194278942115", "-1/22",
                                                              "1.260093847963957508667258498308507117995"}};

}  // namespace hamflow::splittings
