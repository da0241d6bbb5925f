// McLachlan's five stages of fourth order for quadratic T; six drifts, a_3 = 1/2 - a_1 - a_2.
// [McLachlan1995, SB3A, 5 stages]
// Order 4, 5 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable sb3a_5{
    .name = "sb3a-5",
    .order = 4,
    .reference = "McLachlan1995, SB3A, 5 stages",
    .starts_with = StartsWith::drift,
    .symmetric = true,
    .nystroem = true,
    .coefficients = {"0.4051886183952522772205531983898517327134", "-3/73",
                     "-0.2871440408165240889966277933622274550686", "17/59",
                     "0.3819554224212718117760745949723757223551", "0.5059205943812398421174831669375435337822"}};

}  // namespace hamflow::splittings
