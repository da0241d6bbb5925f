// What walls demand of a method, for all that take another one than the scenario's.
#pragma once

#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Why the walls of a request cannot be met by its method and arithmetic, and what is allowed; empty where they can, or
/// where there are none.
std::string refused_by_walls(const Request& request, const ProblemEntry& problem, const std::vector<double>& start_q);
/// "event", ...; empty without walls.
std::string rule_of_walls(const Request& request);

}  // namespace hamflow
