// A block of lanes for any simulations whose steps are recorded. Nothing is compiled for a particular problem.
#pragma once

#include <memory>

#include "hamflow/run/ensemble.hpp"

namespace hamflow {

/// Makes a block. Returns null if the steps of the request are not recorded.
std::unique_ptr<EnsembleBlock> make_recorded_block(const std::shared_ptr<const ProblemEntry>& problem,
                                                   const Request& request, LaneSet lanes);

}  // namespace hamflow
