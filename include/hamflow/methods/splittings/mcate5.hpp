// McLachlan's and Atela's optimal fifth order for quadratic T.   [McLachlanAtela1992, order 5]
// Order 5, 6 force evaluations per step, symplectic. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable mcate5{
    .name = "mcate5",
    .order = 5,
    .reference = "McLachlanAtela1992, order 5",
    .starts_with = StartsWith::kick,
    .nystroem = true,
    .coefficients = {"0.1193900292875672757946361760337133352173", "0.3398396258391100000002594128544637334082",
                     "0.6989273703824752308346490434144751145272", "-0.08860133690302732865254033627137775780944",
                     "-0.1713123582716007754075364378068779223490", "0.5858564768259621188100874358673177288440",
                     "0.4012695022513534479958287872529082862655", "-0.6030393565364918881986069962221282985767",
                     "0.01070508184823598398738116420316283991027", "0.3235807965546976393257049386583803716870",
                     "-0.05897962549803116320495873309738165357132", "0.4423637942197494587150955451133442224469"}};

}  // namespace hamflow::splittings
