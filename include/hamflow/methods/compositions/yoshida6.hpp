// Yoshida's solution A with seven Stoermer-Verlet steps.   [Yoshida1990, table 1; HLW2006, V.(3.11)]
// Order 6, seven force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable yoshida6{
    .name = "yoshida6",
    .order = 6,
    .reference = "Yoshida1990, solution A; HLW2006, V.(3.11)",
    .half = {"0.7845136104775572638194976338663498757768", "0.2355732133593581336847931829785346016865",
             "-1.177679984178871006946415680964315734639"}};

}  // namespace hamflow::compositions
