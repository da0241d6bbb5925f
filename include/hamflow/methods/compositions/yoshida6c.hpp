// Yoshida's solution C with seven Stoermer-Verlet steps.   [Yoshida1990, table 1, solution C]
// Order 6, 7 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable yoshida6c{
    .name = "yoshida6c",
    .order = 6,
    .reference = "Yoshida1990, table 1, solution C",
    .half = {"1.447782562399297932897896663298926738236", "-2.144035316305389310601301806659889194070",
             "0.001528862284249270252267238617205591757762"}};

}  // namespace hamflow::compositions
