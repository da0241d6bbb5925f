// A formula as LaTeX, for notebooks.
#pragma once

#include <string>

namespace hamflow {

/// LaTeX of a typed formula or of a formula of the catalogue ("H = |p|^2/(2 m) + m g y"). Products, sums and
/// parentheses are kept as written; quotients become fractions. Text that is not a formula is shown as words.
/// @return an empty string for a text longer than 2000 characters
std::string tex_of(const std::string& formula);

}  // namespace hamflow
