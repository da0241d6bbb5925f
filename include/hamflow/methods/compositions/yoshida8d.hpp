// Yoshida's solution D under its original name; yoshida8 is the same method.   [Yoshida1990, table 2, solution D] Order
// 8, 15 force evaluations per step, symplectic, symmetric. Digits: those of yoshida8.
#pragma once

#include "hamflow/methods/compositions/yoshida8.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable yoshida8d{
    .name = "yoshida8d", .order = 8, .reference = "Yoshida1990, table 2, solution D", .half = yoshida8.half};

}  // namespace hamflow::compositions
