// Keys of a scenario that do nothing where it is not run: a comparison, a reversal, a session.
#pragma once

#include <string>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// Notes on unused measurements, such as "run.section is not used: WHY"; empty if all are used.
std::vector<std::string> unused_measures(const Scenario& scenario, const std::string& why);
/// The same of output.figures.
std::vector<std::string> unused_figures(const Scenario& scenario, const std::string& why);

}  // namespace hamflow
