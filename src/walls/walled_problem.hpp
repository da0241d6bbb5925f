// Problems with walls as entries of the catalogue, made on request.
#pragma once

#include "hamflow/run/catalog.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

/// The entry of a problem with walls.
std::shared_ptr<const ProblemEntry> walled_problem(const std::string& name,
                                                   const std::map<std::string, std::string>& choices,
                                                   const Walls& walls);
/// For each invariant of the problem without walls, whether it still holds.
std::vector<bool> kept_invariants(const Request& request, const Walls& walls);

}  // namespace hamflow
