// A closed form is used only if its rounding error is known to be small.
#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace hamflow {

/// q, then p.
using LongState = std::vector<long double>;
/// The state at time t from z at time 0, computed in long double; empty if the closed form does not give it.
using LongMotion = std::function<std::optional<LongState>(const LongState& z, long double t)>;

/// The state at time t, if the rounding error of the closed form is at most a quarter of the rounding of a double, or a
/// sixteenth of the effect of rounding the start and the time. The rounding error is measured: a smooth function has
/// small third differences over neighbouring starts, so larger ones are noise. [MoreWild2011] @param is_angle for each
/// coordinate: whether it is known only modulo 2 pi
std::optional<LongState> exact_state_if_accurate(const LongMotion& motion, const LongState& start, long double t,
                                                 const std::vector<bool>& is_angle);

}  // namespace hamflow
