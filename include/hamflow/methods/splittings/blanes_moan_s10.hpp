// Blanes' and Moan's ten stages of sixth order.   [BlanesMoan2002, S10]
// Order 6, 10 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable blanes_moan_s10{
    .name = "blanes-moan-s10",
    .order = 6,
    .reference = "BlanesMoan2002, S10",
    .starts_with = StartsWith::kick,
    .symmetric = true,
    .coefficients = {"0.05026276440039272276463501706551157802999", "0.1488164479010432804573382503624305490099",
                     "0.4135143004283434774541367150491272930119", "-0.1323858657677837561493469658764191817796",
                     "0.04507988979439811148986108449994759793866", "0.06730760469218439924077148588987427738938",
                     "-0.1880548538195686184904252832565255703991", "0.4326664025781737116335833140130967131357",
                     "0.5419606784507800123668921918616562122025", "-0.01640458940361763518234608438898235775534",
                     "-0.7255255585086914111701994504394342215678"}};

}  // namespace hamflow::splittings
