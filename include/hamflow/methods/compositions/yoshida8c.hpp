// Yoshida's solution C with fifteen Stoermer-Verlet steps.   [Yoshida1990, table 2, solution C]
// Order 8, 15 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable yoshida8c{
    .name = "yoshida8c",
    .order = 8,
    .reference = "Yoshida1990, table 2, solution C",
    .half = {"0.6290306502103707998984046604257841744873", "1.369349464168817700556147569469878237153",
             "-1.064587147891825070535124921887410471676", "1.663358099633505179757657390606008440035",
             "-1.678969282596738471212613125110378138270", "-1.559468038214702588209394727567015162699",
             "0.3117908124184667725520545822806452091149"}};

}  // namespace hamflow::compositions
