// Blanes' and Moan's fourteen stages of sixth order for quadratic T.   [BlanesMoan2002, SRKN 14 a]
// Order 6, 14 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable srkn14a{
    .name = "srkn14a",
    .order = 6,
    .reference = "BlanesMoan2002, SRKN 14 a",
    .starts_with = StartsWith::drift,
    .symmetric = true,
    .nystroem = true,
    .coefficients = {"0.03785931984061101628651598083158922810194", "0.09171915262446217541522945135181400640097",
                     "0.1026356331024366056085846918086703440120", "0.1839831700050048822786243402456482177880",
                     "-0.02586788826655835032544015168985375483594", "-0.05653436583288916926143176483035186979870",
                     "0.3142414030714464093086677857702104212993", "0.004914688774711813118083983037926337421973",
                     "-0.1301444595174151970157910854852828071314", "0.1437611271683618419692682384371497810425",
                     "0.1064177003695418294877994883866929884902", "0.3285676937468034573566523215189298615566",
                     "-0.008794243128510174632638512560938971653065", "-0.1964114664864550008764265697611163344114",
                     "0.2073050690568957225646036058778251034339"}};

}  // namespace hamflow::splittings
