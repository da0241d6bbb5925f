// Sofroniou's and Spaletta's twenty-one Stoermer-Verlet steps.   [SofroniouSpaletta2005, s21odr8]
// Order 8, 21 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable sofroniou8{
    .name = "sofroniou8",
    .order = 8,
    .reference = "SofroniouSpaletta2005, s21odr8",
    .half = {"0.1064772898455003182393196785489585149578", "0.1083740864583572639743341059154592209558",
             "0.3533782105265434241953454132407993398438", "-0.2334141402316508219878028112831947961105",
             "-0.2444526679152884126946217141321641731418", "0.1131784843575563331470095251559897510452",
             "0.1189290562500035006269297228395084736925", "0.1260391232182598814030567026836462332224",
             "0.1258171873617604180439239164158662220343", "0.1169913501921764218072288143353290669919"}};

}  // namespace hamflow::compositions
