// The shortest text of a number, as std::to_chars writes it, for a library that has none for double.
#pragma once

#include <string>

namespace hamflow {

/// The shortest text that reads back as x, with an exponent if that is shorter.
std::string shortest_text(double x);

}  // namespace hamflow
