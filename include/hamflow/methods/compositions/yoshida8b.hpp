// Yoshida's solution B with fifteen Stoermer-Verlet steps.   [Yoshida1990, table 2, solution B]
// Order 8, 15 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable yoshida8b{
    .name = "yoshida8b",
    .order = 8,
    .reference = "Yoshida1990, table 2, solution B",
    .half = {"1.488192292029213100801708343069397122450", "-2.338648151010419430977557524610729305620",
             "2.891051489721989000613590345560366654748", "-2.896882503304239868589323300579081439605",
             "0.003780395883626682236870708434710522656086", "2.891957443158173912479732968588881579402",
             "-0.001692485877717065591702165525799056667918"}};

}  // namespace hamflow::compositions
