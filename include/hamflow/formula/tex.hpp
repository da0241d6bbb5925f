// A formula as LaTeX, for notebooks.
#pragma once

#include <string>

namespace hamflow {

/// LaTeX of a formula as it is typed, and as the catalogue writes it ("H = |p|^2/(2 m) + m g y"). Products, sums and
/// parentheses stay as they were written; quotients become fractions. Whatever is no formula stands there as words.
/// @return empty for a text longer than 2000 characters
std::string tex_of(const std::string& formula);

}  // namespace hamflow
