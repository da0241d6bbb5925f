// The entries `orbit` of a run beyond double, with its digits.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// Replaces the radii, the apsidal angle and the radial period of an orbit that was found from the start in double by
/// decimal texts with the digits of the run, and adds "uncertainty": what a rounding of the run's arithmetic in the
/// start makes of each. What is not finite, or not found in more digits, stays as it is, and its uncertainty is null.
void add_orbit_digits(const Scenario& scenario, nlohmann::ordered_json& orbit);

}  // namespace hamflow
