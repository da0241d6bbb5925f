// Blanes' and Moan's six stages of fourth order.   [BlanesMoan2002, S6]
// Order 4, 6 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable blanes_moan_s6{
    .name = "blanes-moan-s6",
    .order = 4,
    .reference = "BlanesMoan2002, S6",
    .starts_with = StartsWith::kick,
    .symmetric = true,
    .coefficients = {"0.07920369643119567419764962376313816651194", "0.2095151066133620529724499860936093178064",
                     "0.3531729060497740368186655573031425943496", "-0.1438517731798180379640962992327095997669",
                     "-0.04206508035771952921517158087661579516925", "0.4343366665664559849916463131391002819605",
                     "0.2193769557534996363977127996206700686154"}};

}  // namespace hamflow::splittings
