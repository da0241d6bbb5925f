// The classical Runge-Kutta method.   [Kutta1901; HLW2006, II.(1.8)]
// Order 4, four evaluations per step; its energy drifts linearly.
#pragma once

#include "hamflow/methods/runge_kutta.hpp"

namespace hamflow::tableaus {

inline constexpr ButcherTableau<4> rk4{
    .name = "rk4",
    .order = 4,
    .reference = "Kutta1901; HLW2006, II.(1.8)",
    .a = {{{}, {Ratio{1, 2}}, {Ratio{0, 1}, Ratio{1, 2}}, {Ratio{0, 1}, Ratio{0, 1}, Ratio{1, 1}}}},
    .b = {Ratio{1, 6}, Ratio{1, 3}, Ratio{1, 3}, Ratio{1, 6}}};

}  // namespace hamflow::tableaus
