// Suzuki's fractal of five Stoermer-Verlet steps: gamma_1 = gamma_2 = 1/(4 - 4^(1/3)).   [Suzuki1990; HLW2006,
// II.(4.5)] Order 4, five force evaluations per step, symplectic, symmetric; smaller error terms than the triple jump.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable suzuki4{.name = "suzuki4",
                                          .order = 4,
                                          .reference = "Suzuki1990; HLW2006, II.(4.5)",
                                          .half = {"0.4144907717943757371423540628607614957117746040167",
                                                   "0.4144907717943757371423540628607614957117746040167"},
                                          .closed_half = {"1/(4 - 4^(1/3))", "1/(4 - 4^(1/3))"}};

}  // namespace hamflow::compositions
