// Tangent vectors through recorded steps: the program of a step, differentiated (src/numerics/program_tangent.hpp), as
// a loop.
#pragma once

#include <functional>
#include <optional>

#include "hamflow/detail/run/step_map.hpp"
#include "recorded_step.hpp"

namespace hamflow {

/// Records a step of length h in double, without a probe, from (q, p) or on from the step before.
using TangentRecorder = std::function<std::optional<RecordedStep>(
    const Vector<double, dynamic>& q, const Vector<double, dynamic>& p, double h, RecordedAt at)>;

/// Which values carry slopes, of programs of the step from a state and of those that follow: the state, the first
/// `state` values, and what moves with it.
std::vector<std::size_t> moving_values(const Program& start, std::size_t state);
/// A program with slopes of those values. Nothing where it cannot be differentiated.
std::optional<Program> with_moving(const Program& program, std::span<const std::size_t> moving, std::size_t vectors);

/// The steps have the bits of the run. Copies share what was compiled; several threads may use them.
TangentSteps recorded_tangents(TangentRecorder recorder);

}  // namespace hamflow
