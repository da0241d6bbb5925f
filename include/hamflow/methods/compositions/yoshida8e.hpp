// Yoshida's solution E with fifteen Stoermer-Verlet steps.   [Yoshida1990, table 2, solution E]
// Order 8, 15 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable yoshida8e{
    .name = "yoshida8e",
    .order = 8,
    .reference = "Yoshida1990, table 2, solution E",
    .half = {"1.303001657575168384905635027389114204692", "0.1079904677180982796054062910782108600611",
             "-2.048097958834902056442551589630625257302", "0.005360189213752380834896528889859730124573",
             "-0.07191800536507050747810125494202801367710", "2.527789273180283391827628450741291140210",
             "0.02277388401263122598349086598251958498710"}};

}  // namespace hamflow::compositions
