// Triple jump of Stoermer-Verlet: gamma_1 = 1/(2 - 2^(1/3)).   [Sonnleitner2010, p. 54; Yoshida1990]
// Order 4, three force evaluations per step, symplectic, symmetric.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable stv4{.name = "stv4",
                                       .order = 4,
                                       .reference = "Sonnleitner2010, p. 54; Yoshida1990",
                                       .half = {"1.3512071919596576340476878089714608269219993762171"},
                                       .closed_half = {"1/(2 - 2^(1/3))"}};

}  // namespace hamflow::compositions
