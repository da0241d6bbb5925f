// Keys of a scenario that do nothing where it is not run: a comparison, a reversal, a session.
#pragma once

#include <string>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// What is measured beside a run: "run.section is not used: WHY"; none where nothing is.
std::vector<std::string> unused_measures(const Scenario& scenario, const std::string& why);
/// The same of output.figures.
std::vector<std::string> unused_figures(const Scenario& scenario, const std::string& why);

}  // namespace hamflow
