// The entries `orbit` of a run beyond double, with its digits.
#pragma once

#include "hamflow/scenario/scenario.hpp"
#include "hamflow/workflow/summary.hpp"

namespace hamflow {

/// Gives the radii, the apsidal angle and the radial period of an orbit that was found from the start in double the
/// digits of the run, and adds how far one rounding of the start, in the run's arithmetic, moves each. A number that is
/// not finite or not found keeps its double, and its uncertainty is not known.
void add_orbit_digits(const Scenario& scenario, OrbitSummary& orbit);

}  // namespace hamflow
