// What bounces off hard walls are called among the events of a summary and of a sweep.
#pragma once

#include <string>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// For each hard wall, in the order in which a simulation counts them, the name of its bounces: "wall:q1:max"; of a gas
/// "wall:x:max", where all particles are counted together.
std::vector<std::string> bounce_names(const Scenario& scenario);

}  // namespace hamflow
