// A block of lanes made of any simulations whose steps are recorded: nothing is compiled for a problem.
#pragma once

#include <memory>

#include "hamflow/run/ensemble.hpp"

namespace hamflow {

/// Null if the steps of such a request are not recorded.
std::unique_ptr<EnsembleBlock> make_recorded_block(const std::shared_ptr<const ProblemEntry>& problem,
                                                   const Request& request, LaneSet lanes);

}  // namespace hamflow
