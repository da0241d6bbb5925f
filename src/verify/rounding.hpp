// Unit of rounding. The bounds of the verification are multiples of it.
#pragma once

#include <limits>

namespace hamflow {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace hamflow
