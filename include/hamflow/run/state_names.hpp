// What the numbers of a state are called, for a system of any size: in files, labels, tables and the keys of a
// scenario.
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

/// The name of the momentum that belongs to a coordinate: p of q, p1 of q1, p_x of x, p_x1 of x1.
std::string momentum_name(const std::string& coordinate);

/// q1, q2, ... and p1, p2, ...: what any system of any size may call them.
StateNames numbered_names(std::size_t size);

/// The names that the problem declares. Of any number of bodies in space: x1, y1, x2, ... in the plane, else x1, y1,
/// z1, x2, ...; of any other system of any size q1, q2, ...
/// @param parameters complete   @param size of q, which the problem accepts
StateNames state_names(const ProblemEntry& problem, const Texts& parameters, std::size_t size);

}  // namespace hamflow
