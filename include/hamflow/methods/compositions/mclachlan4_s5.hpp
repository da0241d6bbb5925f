// McLachlan's five Stoermer-Verlet steps with gamma_1 = 0.28 chosen for a small error.   [McLachlan1995, SS, 5 stages]
// Order 4, 5 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable mclachlan4_s5{.name = "mclachlan4-s5",
                                                .order = 4,
                                                .reference = "McLachlan1995, SS, 5 stages",
                                                .half = {"0.28", "0.6254664284676700450123389054926490129182"}};

}  // namespace hamflow::compositions
