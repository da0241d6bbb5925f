// Stoermer-Verlet, kick-drift-kick: StV_h = EulerA(h/2) o EulerB(h/2).   [Sonnleitner2010, p. 52; HLW2006, Sect. I.1.4]
// Order 2, one force evaluation per step, symplectic, symmetric. "-dkd": drift-kick-drift (Sonnleitner2010, p. 53).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable verlet{
    .name = "verlet",
    .order = 2,
    .reference = "Sonnleitner2010, p. 52; HLW2006, Sect. I.1.4",
    .advice = {
        .purpose = "H = T(p) + V(q): try it first; the cheapest step, also if V is not smooth",
        .take = "a relative accuracy of about 1e-4 is enough, forces are expensive or not smooth, or there are walls",
        .avoid = "more digits are needed: stv4, kahan-li8; H is not T(p) + V(q): cg takes any H"}};

}  // namespace hamflow::compositions
