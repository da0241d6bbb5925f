// Tangent vectors through recorded steps: the differentiated program of a step (src/numerics/program_tangent.hpp) as a
// loop.
#pragma once

#include <functional>
#include <optional>

#include "hamflow/detail/run/step_map.hpp"
#include "recorded_step.hpp"

namespace hamflow {

/// Records a step of length h in double, without a probe, either from (q, p) or as the continuation of a step.
using TangentRecorder = std::function<std::optional<RecordedStep>(
    const Vector<double, dynamic>& q, const Vector<double, dynamic>& p, double h, RecordedAt at)>;

/// Returns the values that need slopes, in the program of the first step from a state and in those of the following
/// steps: the first `state` values, which are the state, and all values that depend on it.
std::vector<std::size_t> moving_values(const Program& start, std::size_t state);
/// Adds slopes of these values to a program. Returns nullopt if it cannot be differentiated.
std::optional<Program> with_moving(const Program& program, std::span<const std::size_t> moving, std::size_t vectors);

/// Returns steps with the bits of the run. Copies share the compiled loops, and several threads may use them.
TangentSteps recorded_tangents(TangentRecorder recorder);

}  // namespace hamflow
