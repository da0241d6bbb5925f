// Kahan's and Li's nine Stoermer-Verlet steps.   [KahanLi1997, s9odr6a; HLW2006, V.(3.12)]
// Order 6, 9 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable kahan_li6{
    .name = "kahan-li6",
    .order = 6,
    .reference = "KahanLi1997, s9odr6a; HLW2006, V.(3.12)",
    .half = {"0.3921614440073141392792505574226714038049", "0.3325991367893594385997486375000496468816",
             "-0.7062461725576393598099648195492564593955", "0.08221359629355080023149044810205633110329"}};

}  // namespace hamflow::compositions
