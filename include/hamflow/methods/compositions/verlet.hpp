// Stoermer-Verlet, kick-drift-kick: StV_h = EulerA(h/2) o EulerB(h/2).   [Sonnleitner2010, p. 52; HLW2006, Sect. I.1.4]
// Order 2, one force evaluation per step, symplectic, symmetric. "-dkd": drift-kick-drift (Sonnleitner2010, p. 53).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable verlet{
    .name = "verlet", .order = 2, .reference = "Sonnleitner2010, p. 52; HLW2006, Sect. I.1.4"};

}  // namespace hamflow::compositions
