// Explanations of options for `new`, `show` and docs/reference.md.
#pragma once

#include <string>

#include "hamflow/detail/core/option_info.hpp"

namespace hamflow {

/// Returns meaning, allowed values, condition and unit: "step size; a number other than 0; in units of time".
std::string explained(const OptionInfo& option);
/// The same, followed by the default: "; default 15", "; by default its rounding level", "; required".
std::string explained_with_default(const OptionInfo& option);
/// Returns an example value as TOML: the declared example, else the default, else 1 or a list with it.
std::string example_text(const OptionInfo& option);

}  // namespace hamflow
