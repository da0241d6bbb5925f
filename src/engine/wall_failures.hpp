// A failure at walls that a smaller step size does not avoid.
#pragma once

#include <string_view>

namespace hamflow {

/// The end of the message if a momentum cannot be reversed, because H has no second root in it.
inline constexpr std::string_view no_other_momentum = "no other momentum of that coordinate has the same energy";

}  // namespace hamflow
