// A closed form is taken only where its own rounding is known to be small.
#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace hamflow {

/// q, then p.
using LongState = std::vector<long double>;
/// The state at time t from z at time 0, computed in long double; empty where the closed form does not know it.
using LongMotion = std::function<std::optional<LongState>(const LongState& z, long double t)>;

/// The motion's state at time t, if the rounding of the closed form itself changes it by no more than a quarter of a
/// rounding of double, or a sixteenth of what a rounding of the start and of the time would change. The rounding is
/// measured: over neighbouring starts a smooth function has small third differences, so larger ones are noise.
/// [MoreWild2011]   @param is_angle of each coordinate: it is known up to whole turns
std::optional<LongState> known_exact(const LongMotion& motion, const LongState& start, long double t,
                                     const std::vector<bool>& is_angle);

}  // namespace hamflow
