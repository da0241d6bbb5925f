// Blanes' and Moan's six stages of fourth order for quadratic T.   [BlanesMoan2002, SRKN 6 b]
// Order 4, 6 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable srkn6b{
    .name = "srkn6b",
    .order = 4,
    .reference = "BlanesMoan2002, SRKN 6 b",
    .starts_with = StartsWith::kick,
    .symmetric = true,
    .nystroem = true,
    .coefficients = {"0.08298440641740498233489856731318980930064", "0.2452989571842711234486544562783017497528",
                     "0.3963098014983680618539546437068754472031", "0.6048726657110799236261843298925867611357",
                     "-0.03905630492234843733430565342911769468788", "-0.3501716228953510470748387861708885108885",
                     "0.1195241940131507862909048848181048763683"}};

}  // namespace hamflow::splittings
