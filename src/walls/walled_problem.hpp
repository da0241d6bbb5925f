// Problems behind walls, as entries of the catalogue: made when they are asked for.
#pragma once

#include "hamflow/run/catalog.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

/// The entry of a problem behind walls.
std::shared_ptr<const ProblemEntry> walled_problem(const std::string& name,
                                                   const std::map<std::string, std::string>& choices,
                                                   const Walls& walls);
/// Which invariants of the problem without walls they leave.
std::vector<bool> kept_invariants(const Request& request, const Walls& walls);

}  // namespace hamflow
