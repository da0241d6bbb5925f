// The names of the numbers of a state, for a system of any size, in files, labels, tables and scenario keys.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// A name for each number of q and of p.
struct StateNames {
  std::vector<std::string> q;  // coordinates
  std::vector<std::string> p;  // momenta
};

/// The name of the momentum of a coordinate: p for q, p1 for q1, p_x for x, p_x1 for x1.
std::string momentum_name(const std::string& coordinate);

/// q1, q2, ... and p1, p2, ..., valid for any system.
StateNames numbered_names(std::size_t size);

/// The names that the problem declares. For any number of bodies: x1, y1, x2, ... in the plane, x1, y1, z1, x2, ... in
/// space. For other systems of any size: q1, q2, ...
/// @param parameters complete @param size of q, accepted by the problem
StateNames state_names(const ProblemEntry& problem, const Texts& parameters, std::size_t size);

}  // namespace hamflow
