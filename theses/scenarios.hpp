// The scenarios of the experiments. They are TOML files in scenarios/, which the build embeds into the program.
#pragma once

#include <string>
#include <vector>

namespace hamflow::reproduction {

/// Returns the text of scenarios/NAME.toml with some keys changed.   @param sets PATH=VALUE, as --set takes them
/// @throws Error if there is no such file, or if the changed scenario is wrong
std::string scenario_of(const std::string& name, const std::vector<std::string>& sets = {});

/// Returns the changes that set keys of [run], and the table [method] if one is given. @param dt a number expression
std::vector<std::string> in_steps(const std::string& dt, long steps, long every = 1, const std::string& method = {});

/// The method of reference solutions: Taylor series, exact up to rounding.
inline const std::string by_series = "method={ name = \"taylor\", tolerance = 1e-15 }";

}  // namespace hamflow::reproduction
