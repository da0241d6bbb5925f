// A complete scenario for a problem, with every key that it may have explained beside it.
#pragma once

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// TOML that can be read and run as it is. Of several starts the one that the example names is active, the others stand
/// as comments.
/// @param example complete: with the values of the region where the problem declares none of its own
std::string scenario_template(const ProblemEntry& problem, const ExampleInfo& example);

}  // namespace hamflow
