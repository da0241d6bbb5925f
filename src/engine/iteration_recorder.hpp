// Averages as programs, for lanes.
#pragma once

#include "erased.hpp"
#include "iteration_runner.hpp"

namespace hamflow {

/// Empty where a step is no program, for every start the same but for constants.
/// @param capabilities one of Averages::capability_sets, on which the simulation works
IterationRecorder iteration_recorder(const ErasedFunctions<double>& functions, Capability capabilities,
                                     const AverageOptions& options);

/// Empty where stages are not iterated by fixed point, or there is no machine code for lanes here.
StageRecorder stage_recorder(const ErasedFunctions<double>& functions, Capability capabilities,
                             const AverageOptions& options);

}  // namespace hamflow
