// A complete scenario for a problem, with an explanation of every key that it may have.
#pragma once

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// TOML that can be run without changes. If there are several starts, the one that the example names is active and the
/// others are comments.
/// @param example complete; values that the problem does not declare are those of its region
std::string scenario_template(const ProblemEntry& problem, const ExampleInfo& example);

}  // namespace hamflow
