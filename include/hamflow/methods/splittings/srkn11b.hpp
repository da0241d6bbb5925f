// Blanes' and Moan's eleven stages of sixth order for quadratic T.   [BlanesMoan2002, SRKN 11 b]
// Order 6, 11 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable srkn11b{
    .name = "srkn11b",
    .order = 6,
    .reference = "BlanesMoan2002, SRKN 11 b",
    .starts_with = StartsWith::kick,
    .symmetric = true,
    .nystroem = true,
    .coefficients = {"0.04146499851826284228254482692985465561754", "0.1232297759462711501601075990767785346411",
                     "0.1981286719180665258890071581558543016592", "0.2905537977995582911524099370514517918666",
                     "-0.04000619210415269278089930255155497112574", "-0.1270492126254169972568878091382008683291",
                     "0.07525398430158030944975212372187071809039", "-0.2463317610620754357127064549011311813408",
                     "-0.01151138742068775604380885002295739468699", "0.3572088727959278633357700752090397635246",
                     "0.2366699247869307712034040437669326904456", "0.2047770542914702566426133054041239192753"}};

}  // namespace hamflow::splittings
