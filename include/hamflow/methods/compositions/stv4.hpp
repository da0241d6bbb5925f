// Triple jump of Stoermer-Verlet: gamma_1 = 1/(2 - 2^(1/3)).   [Sonnleitner2010, p. 54; Yoshida1990]
// Order 4, three force evaluations per step, symplectic, symmetric.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable stv4{
    .name = "stv4",
    .order = 4,
    .reference = "Sonnleitner2010, p. 54; Yoshida1990",
    .half = {"1.3512071919596576340476878089714608269219993762171"},
    .closed_half = {"1/(2 - 2^(1/3))"},
    .advice = {.purpose = "H = T(p) + V(q): more accurate, still simple; three forces per step",
               .take = "about six digits are needed, for a smooth H = T(p) + V(q)",
               .avoid = "nine digits or more are needed: kahan-li8, rkn8-s19; V is not "
                        "smooth: verlet; H is not T(p) + V(q): cg takes any H"}};

}  // namespace hamflow::compositions
