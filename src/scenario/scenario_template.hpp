// A scenario for a problem, to begin with: the keys that matter, or every key, explained beside it.
#pragma once

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// TOML that can be read and run as it is. Of several starts the one that the example names is set.
/// @param example complete: with the values of the region where the problem declares none of its own
/// @param method with its options; an empty name: the usual one of the problem
/// @param all every key that the problem may have, those that are not set as comments; false: what is set alone
std::string scenario_template(const ProblemEntry& problem, const ExampleInfo& example, const MethodSpec& method,
                              bool all);

}  // namespace hamflow
