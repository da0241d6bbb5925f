// Computes the `orbit` entries of the summary with the digits of the run, for arithmetic with more digits than double.
#pragma once

#include "hamflow/scenario/scenario.hpp"
#include "hamflow/workflow/summary.hpp"

namespace hamflow {

/// Refines the radii, the apsidal angle and the radial period from double to the digits of the run. Adds as uncertainty
/// the change of each by one rounding of the start in the run's arithmetic. A number that is not finite or not found
/// stays a double and has no uncertainty.
void add_orbit_digits(const Scenario& scenario, OrbitSummary& orbit);

}  // namespace hamflow
