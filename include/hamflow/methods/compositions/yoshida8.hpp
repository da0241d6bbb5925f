// Yoshida's solution D with fifteen Stoermer-Verlet steps.   [Yoshida1990, table 2, solution D]
// Order 8, 15 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable yoshida8{
    .name = "yoshida8",
    .order = 8,
    .reference = "Yoshida1990, table 2, solution D",
    .half = {"0.9148442462297915667487934898475096045181", "0.2536933365662113541461460206899420760977",
             "-1.444852236860605157694730657537390354956", "-0.1582406353680501752040667767597542477554",
             "1.938139137622525986579186487443641760954", "-1.960610232975310807607633376399663640792",
             "0.1027998493917964406981151316012258629110"}};

}  // namespace hamflow::compositions
