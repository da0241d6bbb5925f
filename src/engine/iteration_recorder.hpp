// Records the steps of methods with averages as programs, for lanes.
#pragma once

#include "erased.hpp"
#include "iteration_runner.hpp"

namespace hamflow {

/// Empty if a step is not a program that is the same for every start except for constants.
/// @param capabilities one of Averages::capability_sets, on which the simulation works
IterationRecorder iteration_recorder(const ErasedFunctions<double>& functions, Capability capabilities,
                                     const AverageOptions& options);

/// Empty if stages are not solved by fixed-point iteration, or there is no machine code for lanes here.
StageRecorder stage_recorder(const ErasedFunctions<double>& functions, Capability capabilities,
                             const AverageOptions& options);

}  // namespace hamflow
