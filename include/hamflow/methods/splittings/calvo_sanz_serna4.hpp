// Calvo's and Sanz-Serna's fourth order for quadratic T.   [CalvoSanzSerna1993]
// Order 4, 4 force evaluations per step, symplectic. Digits refined to 40 from the order conditions
// (tools/refine_coefficients.py): the nearest solution to the published ones.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable calvo_sanz_serna4{
    .name = "calvo-sanz-serna4",
    .order = 4,
    .reference = "CalvoSanzSerna1993",
    .starts_with = StartsWith::kick,
    .nystroem = true,
    .coefficients = {"0.06175885813562880656600787488103192526996", "0.2051776615422892565166489038375703954314",
                     "0.3389780265536420232779951634023699431685", "0.4030212816042118297717387048647444375032",
                     "0.6147913071755781099102698635712779419801", "-0.1209208763389116025349391201331861347764",
                     "-0.1405480146593752292829038866143188948761", "0.5127219331924105162465515114308713018417",
                     "0.1250198227945262895286309847596390844576"}};

}  // namespace hamflow::splittings
