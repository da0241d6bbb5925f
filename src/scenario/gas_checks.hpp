// Limits of methods for many coordinates. Code that uses another method than the scenario's has to check it, too.
#pragma once

#include <string>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Explains why a method cannot be used with so many coordinates, and what is allowed; empty if it can be used.
std::string refused_by_size(const Request& request, std::size_t coordinates);

}  // namespace hamflow
