// McLachlan's five stages of fourth order.   [McLachlan1995, S, 5 stages]
// Order 4, 5 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable mclachlan_s5{.name = "mclachlan-s5",
                                             .order = 4,
                                             .reference = "McLachlan1995, S, 5 stages",
                                             .starts_with = StartsWith::kick,
                                             .symmetric = true,
                                             .coefficients = {"0.08926945422647524488669461126055911426725", "2/5",
                                                              "-0.09733604263689550801535994339830842235147", "-1/10",
                                                              "0.5080665884104202631286653321377493080842", "2/5"}};

}  // namespace hamflow::splittings
