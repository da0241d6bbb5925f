// Checks whether a method works with walls. Code that uses another method than the scenario's calls this, too.
#pragma once

#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Explains why the walls of a request do not work with its method and arithmetic, and what is allowed; empty if they
/// do, or if there are no walls.
std::string refused_by_walls(const Request& request, const ProblemEntry& problem, const std::vector<double>& start_q);
/// Returns "event" or another rule; empty without walls.
std::string rule_of_walls(const Request& request);

}  // namespace hamflow
