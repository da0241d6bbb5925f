// The entries `orbit` of a run beyond double, with its digits.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// Replaces the radii, the apsidal angle and the radial period of an orbit that was found from the start in double by
/// decimal texts with the digits of the run, and adds "uncertainty": how far one rounding of the start,
/// in the run's arithmetic, moves each. A number that is not finite or not found keeps its double; uncertainty null.
void add_orbit_digits(const Scenario& scenario, nlohmann::ordered_json& orbit);

}  // namespace hamflow
