// Yoshida's solution B with seven Stoermer-Verlet steps.   [Yoshida1990, table 1, solution B]
// Order 6, 7 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable yoshida6b{
    .name = "yoshida6b",
    .order = 6,
    .reference = "Yoshida1990, table 1, solution B",
    .half = {"1.439848167976783090930499281479023182107", "0.004260681870792016196083713828669791332062",
             "-2.132285222001451520705993372220796287854"}};

}  // namespace hamflow::compositions
