// Yoshida's solution A with fifteen Stoermer-Verlet steps.   [Yoshida1990, table 2, solution A]
// Order 8, 15 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable yoshida8a{
    .name = "yoshida8a",
    .order = 8,
    .reference = "Yoshida1990, table 2, solution A",
    .half = {"1.042426208699704264348953268397656476106", "1.820206309706980069331733166121399780809",
             "0.1577399281237083213428257830795420048405", "2.440027326166344063816895897619430943538",
             "-0.007169894197095332099806129249649109481199", "-2.446991823704245889294691452381462484561",
             "-1.615823741500653784787940197458742165897"}};

}  // namespace hamflow::compositions
