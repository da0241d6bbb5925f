// Rejections of the T-tube that are two-to-one: the rule of the listing negates a momentum where a step Psi_h would
// leave the domain, and the state R z so reached has a second preimage where Psi_-h(R z) lies inside.
#pragma once

#include "study.hpp"

namespace hamflow::reproduction {

/// Two-to-one rejections over all, from the geometry: rejections lie in a layer h |v| before a wall; of it the part is
/// two-to-one where the step forward leaves and that backward from the image does not. Both are found by bisection
/// along the normal of the wall, for states spread evenly over the energy surface.
double two_to_one_share(const Study& study, double eps, double energy, double h, int samples, int seed);

/// Two states that the rule sends to one: a rejected one, and that from which a step leads to its image. How many such
/// pairs of one were found, 0 or 1.
Measured explicit_pair();

}  // namespace hamflow::reproduction
