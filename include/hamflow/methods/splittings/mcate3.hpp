// McLachlan's and Atela's optimal third order.   [McLachlanAtela1992, order 3]
// Order 3, 3 force evaluations per step, symplectic. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable mcate3{
    .name = "mcate3",
    .order = 3,
    .reference = "McLachlanAtela1992, order 3",
    .starts_with = StartsWith::kick,
    .coefficients = {"0.2683300957817599249569552299254991394812", "0.9196615230173998570508976381533827895633",
                     "-0.1879916187991597820078528680788819290445", "-0.1879916187991597820078528680788819290445",
                     "0.9196615230173998570508976381533827895633", "0.2683300957817599249569552299254991394812"}};

}  // namespace hamflow::splittings
