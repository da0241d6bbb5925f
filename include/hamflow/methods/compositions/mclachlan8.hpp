// McLachlan's seventeen Stoermer-Verlet steps with gamma_1 = 25/194 chosen for a small error.
// [McLachlan1995, SS, 17 stages]
// Order 8, 17 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable mclachlan8{
    .name = "mclachlan8",
    .order = 8,
    .reference = "McLachlan1995, SS, 17 stages",
    .half = {"25/194", "0.5815140871052509624302422782038136910044", "-0.4101753714698501375324061500890486599642",
             "0.1851469357165877326532719498634894574402", "-0.4095523434208514193398451736889092696187",
             "0.1444059410800120410600751871569277490622", "0.2783355003936796513091070628124172294800",
             "0.3149566839162948578902813119729508819232"}};

}  // namespace hamflow::compositions
