// Chin's algorithm A: V/6, T/2, 2/3 V~, T/2, V/6 with V~ = V - h^2/48 |V'|^2.   [Chin1997]
// Order 4 without backward actions: two forces and one Hessian per step, symplectic, symmetric. In closed form, sign
// and size of the gradient's 2/3 * 1/48 = 1/72 derived from the order conditions in words of drifts and kicks
// (tests/support/order_conditions.hpp).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::force_gradient {

inline constexpr ForceGradientTable chin4a{
    .name = "chin4a",
    .order = 4,
    .reference = "Chin1997, algorithm A",
    .half = {{{.kick = "1/6"}, {.drift = "1/2"}, {.kick = "2/3", .gradient = "1/72"}}}};

}  // namespace hamflow::force_gradient
