// Notes on keys of a scenario that a comparison, a reversal or a session does not use.
#pragma once

#include <string>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// Returns notes on unused measurements, such as "run.section is not used: WHY"; empty if all are used.
std::vector<std::string> unused_measures(const Scenario& scenario, const std::string& why);
/// The same for output.figures.
std::vector<std::string> unused_figures(const Scenario& scenario, const std::string& why);

}  // namespace hamflow
