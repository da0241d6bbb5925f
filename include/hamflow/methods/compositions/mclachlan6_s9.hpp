// McLachlan's nine Stoermer-Verlet steps with gamma_1 = 0.1867 chosen for a small error.
// [McLachlan1995, SS, 9 stages]
// Order 6, 9 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable mclachlan6_s9{
    .name = "mclachlan6-s9",
    .order = 6,
    .reference = "McLachlan1995, SS, 9 stages",
    .half = {"0.1867", "0.5554970237124783991569135436283912009641", "0.1294669489134753580560452092102047808168",
             "-0.8432656233877346085491427813848149898690"}};

}  // namespace hamflow::compositions
