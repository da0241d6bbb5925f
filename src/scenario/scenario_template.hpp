// Writes a scenario for a problem as a starting point: its important keys, or every key, with explanations.
#pragma once

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Returns TOML that can be read and run unchanged. If there are several starts, the one of the example is set.
/// @param example the complete example; uses the values of the region if the problem declares no example
/// @param method method with its options; empty name: the default method of the problem
/// @param all true: write every key that the problem may have, unset ones as comments; false: write only keys that are
/// set
std::string scenario_template(const ProblemEntry& problem, const ExampleInfo& example, const MethodSpec& method,
                              bool all);

}  // namespace hamflow
