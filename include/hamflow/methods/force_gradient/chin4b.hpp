// Chin's algorithm B: t1 T, V~/2, t2 T, V~/2, t1 T, V~ = V - (2 - sqrt(3))/24 h^2 |V'|^2, t1 = (1 - 1/sqrt(3))/2,
// t2 = 1/sqrt(3).   [Chin1997]
// Order 4 without backward actions: two forces and two Hessians per step, symplectic, symmetric. Coefficients are in
// closed form; 1/2 (2 - sqrt(3))/24 of the gradient is derived as for chin4a.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::force_gradient {

inline constexpr ForceGradientTable chin4b{
    .name = "chin4b",
    .order = 4,
    .reference = "Chin1997, algorithm B",
    .half = {{{.drift = "(1-sqrt(1/3))/2"}, {.kick = "1/2", .gradient = "(2-sqrt(3))/48"}, {.drift = "sqrt(1/3)"}}}};

}  // namespace hamflow::force_gradient
