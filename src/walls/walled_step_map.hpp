// The map of a step with walls, which carries tangent vectors through bounces.
#pragma once

#include "engine/erased.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

/// The map of a step without walls.
using MakeStepMap = std::unique_ptr<StepMap> (*)(const ErasedProblem&, const MethodSpec&);

/// @param request with the problem and the method
std::unique_ptr<StepMap> step_map_with_walls(const ErasedProblem& problem, const Request& request, const Walls& walls,
                                             MakeStepMap make);

}  // namespace hamflow
