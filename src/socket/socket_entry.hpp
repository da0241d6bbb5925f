// The problem `socket` as entries of the catalogue, one for each address.
#pragma once

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// The entry of an address. Without an address it only describes the problem: it accepts no method.
/// @throws Error if the address is refused
std::shared_ptr<const ProblemEntry> socket_problem(const std::map<std::string, std::string>& choices);

}  // namespace hamflow
