// Omelyan's, Mryglod's and Folk's optimised fourth order, "position extended Forest-Ruth like":
// drifts xi, chi, 1 - 2 (chi + xi), chi, xi and kicks (1 - 2 lambda)/2, lambda, lambda, (1 - 2 lambda)/2.
// [OmelyanMryglodFolk2002] An ordinary splitting, no gradient of the force.
// Order 4, 4 force evaluations per step, symplectic, symmetric. Two conditions on three numbers: refined to 40 digits
// is the (xi, lambda, chi) nearest to the published ones (tools/refine_coefficients.py).
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable pefrl{
    .name = "pefrl",
    .order = 4,
    .reference = "OmelyanMryglodFolk2002",
    .starts_with = StartsWith::drift,
    .symmetric = true,
    .coefficients = {"0.1786178958448090670599037670811929509843", "0.7123418310626054038318904580688406998850",
                     "-0.06626458266981849627801562176460272959957", "-0.2123418310626054038318904580688406998850",
                     "0.7752933736500188584362237093668195572305"}};

}  // namespace hamflow::splittings
