// McLachlan's and Atela's optimal fourth order for quadratic T.   [McLachlanAtela1992, order 4]
// Order 4, 4 force evaluations per step, symplectic. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable mcate4{
    .name = "mcate4",
    .order = 4,
    .reference = "McLachlanAtela1992, order 4",
    .starts_with = StartsWith::kick,
    .nystroem = true,
    .coefficients = {"0.1344961992774310892055064604585957388528", "0.5153528374311229364001750586248288441869",
                     "-0.2248198030794208058171809489467871171446", "-0.08578201941297364607000340696020795067282",
                     "0.7563200005156682911124975448405539605398", "0.4415830236164665242530612821822822941238",
                     "0.3340036032863214254991769436476374177521", "0.1288461583653841854167670661530968123621"}};

}  // namespace hamflow::splittings
