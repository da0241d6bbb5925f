// Okunbor's and Skeel's method 13: seven stages of sixth order for quadratic T.
// [OkunborSkeel1994, method 13; McLachlan1995]
// Order 6, 7 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable okunbor_skeel6{
    .name = "okunbor-skeel6",
    .order = 6,
    .reference = "OkunborSkeel1994, method 13; McLachlan1995",
    .starts_with = StartsWith::drift,
    .symmetric = true,
    .nystroem = true,
    .coefficients = {"-1.013087978917174729814904578488955908639", "0.0001660069265000989421747072427969753415071",
                     "1.187429573732542707024293320637402200491", "-0.3796242142637736060819469079990920603818",
                     "-0.01833585209646059034438748840973060841363", "0.6891374118518106367408016646578030366064",
                     "0.3439942572810926131349987462612843165622", "0.3806415909709257407979410721969840968678"}};

}  // namespace hamflow::splittings
