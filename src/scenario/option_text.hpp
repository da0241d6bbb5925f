// An option explained for people: beside a key in `new`, in a row of `show`, in docs/reference.md.
#pragma once

#include <string>

#include "hamflow/detail/core/option_info.hpp"

namespace hamflow {

/// "step length; a number other than 0; in units of time": meaning, allowed values, condition and unit.
std::string explained(const OptionInfo& option);
/// The same with the default behind it: "; default 15", "; by default its rounding level", "; required".
std::string explained_with_default(const OptionInfo& option);
/// A value to begin with, as TOML: the example, else the default, else 1 or a list of it.
std::string example_text(const OptionInfo& option);

}  // namespace hamflow
