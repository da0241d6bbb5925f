// Tangent vectors through recorded steps: the program of a step, differentiated (numerics/program_tangent.hpp), as a
// loop.
#pragma once

#include <functional>
#include <optional>

#include "hamflow/run/recorded_step.hpp"
#include "hamflow/run/step_map.hpp"

namespace hamflow {

/// Records a step of length h in double, without a probe, from (q, p) or on from the step before.
using TangentRecorder = std::function<std::optional<RecordedStep>(
    const Vector<double, dynamic>& q, const Vector<double, dynamic>& p, double h, RecordedAt at)>;

/// The steps have the bits of the run. Copies share what was compiled; several threads may use them.
TangentSteps recorded_tangents(TangentRecorder recorder);

}  // namespace hamflow
