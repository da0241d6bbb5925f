// Names of bounces off hard walls, among the events of a summary and of a sweep.
#pragma once

#include <string>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// Returns the names of the bounces off each hard wall, in the order in which a simulation counts them: "wall:q1:max".
/// For a gas the name is "wall:x:max", because all particles are counted together.
std::vector<std::string> bounce_names(const Scenario& scenario);

}  // namespace hamflow
