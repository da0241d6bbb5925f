// How a run behind walls fails for a reason that no step length mends.
#pragma once

#include <string_view>

namespace hamflow {

/// The end of the sentence where a momentum cannot be turned round, because H has no second root in it.
inline constexpr std::string_view no_other_momentum = "no other momentum of that coordinate has the same energy";

}  // namespace hamflow
