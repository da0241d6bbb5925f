// Sofroniou's and Spaletta's thirteen Stoermer-Verlet steps.   [SofroniouSpaletta2005, s13odr6]
// Order 6, 13 force evaluations per step, symplectic, symmetric. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::compositions {

inline constexpr CompositionTable sofroniou6{
    .name = "sofroniou6",
    .order = 6,
    .reference = "SofroniouSpaletta2005, s13odr6",
    .half = {"0.1386193085405169524580801304262535376448", "0.1334656285107476040704685883220925596498",
             "0.1307053101144922519054275578501520434014", "0.1296189375690703477250536653709118417691",
             "-0.3500032489392089651617083091132256056688", "0.1180553065300238717027343895404897553657"}};

}  // namespace hamflow::compositions
