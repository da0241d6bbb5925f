// What a gas of very many particles demands of a method, for all that take another one than the scenario's.
#pragma once

#include <string>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Why a method cannot be used with so many coordinates, and what is allowed; empty where it can.
std::string refused_by_size(const Request& request, std::size_t coordinates);

}  // namespace hamflow
