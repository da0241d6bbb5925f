// The unit of rounding of which the bounds of the verification are multiples.
#pragma once

#include <limits>

namespace hamflow {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace hamflow
