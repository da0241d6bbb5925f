// Two-to-one rejections of the T-tube. If a step Psi_h from z leaves the domain, the rule of the listing negates a
// momentum, z -> R z. If Psi_-h(R z) is in the domain, it is a second preimage of R z, so the map is not injective.
#pragma once

#include "study.hpp"

namespace hamflow::reproduction {

/// Returns the share of rejections that are two-to-one, from the geometry. Rejections are in a layer of thickness h |v|
/// before a wall. They are two-to-one where the step forward leaves the domain, and the step backward from the image
/// does not. Bisection along the normal of the wall finds both limits, for states that are uniform on the energy
/// surface.
double two_to_one_share(const Study& study, double eps, double energy, double h, int samples, int seed);

/// Constructs two states that the rule maps to the same state: a rejected one, and one from which a step leads to the
/// same image. Returns the number of pairs found, 0 or 1.
Measured explicit_pair();

}  // namespace hamflow::reproduction
