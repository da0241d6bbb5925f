// Kahan's and Li's seventeen Stoermer-Verlet steps.   [KahanLi1997, s17odr8a; HLW2006, V.(3.14)]
// Order 8, 17 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable kahan_li8{
    .name = "kahan-li8",
    .order = 8,
    .reference = "KahanLi1997, s17odr8a; HLW2006, V.(3.14)",
    .half = {"0.1302024830888900808788176320967005223572", "0.5611629817751083845619644077001505672662",
             "-0.3894749626448472864080785982352483888361", "0.1588419065551556008962107457071524814121",
             "-0.3959038941332375773362315393479389360268", "0.1845396409783157070918325415333754628190",
             "0.2583743876863220472939791099949394718131", "0.2950117236093102988709662402182281129765"},
    .advice = {.purpose = "H = T(p) + V(q): high accuracy over long times",
               .take = "nine digits or more are needed over millions of steps, for a smooth H = T(p) + V(q)",
               .avoid = "T is quadratic with constant mass matrix: rkn8-s19 is more accurate for the same number of "
                        "forces; few digits are enough: verlet, stv4; H is not T(p) + V(q): cg takes any H"}};

}  // namespace hamflow::compositions
