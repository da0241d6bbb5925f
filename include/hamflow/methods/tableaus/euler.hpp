// Explicit Euler, z1 = z0 + h J grad H(z0).   [Sonnleitner2010, p. 32; HLW2006, I.(1.5)]
// Order 1; neither symplectic nor symmetric: orbits spiral outwards. Weakly reversible, as every Runge-Kutta method.
#pragma once

#include "hamflow/methods/runge_kutta.hpp"

namespace hamflow::tableaus {

inline constexpr ButcherTableau<1> euler{
    .name = "euler", .order = 1, .reference = "Sonnleitner2010, p. 32; HLW2006, I.(1.5)", .b = {Ratio{1, 1}}};

}  // namespace hamflow::tableaus
