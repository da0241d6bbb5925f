// The scenarios of the experiments stand as TOML in scenarios/, which the build puts into the program.
#pragma once

#include <string>
#include <vector>

namespace hamflow::reproduction {

/// The text of scenarios/NAME.toml with some of its keys changed.   @param sets PATH=VALUE, as --set takes them
/// @throws Error where there is no such file, or the changed scenario is refused
std::string scenario_of(const std::string& name, const std::vector<std::string>& sets = {});

/// Changes of [run], with dt a number expression, and of the whole of [method] where one is given.
std::vector<std::string> in_steps(const std::string& dt, long steps, long every = 1, const std::string& method = {});

/// Taylor series to rounding: what other methods are compared with.
inline const std::string by_series = "method={ name = \"taylor\", tolerance = 1e-15 }";

}  // namespace hamflow::reproduction
