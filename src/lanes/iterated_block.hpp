// A block of lanes for simulations whose steps are solved by iteration.
#pragma once

#include <memory>

#include "hamflow/run/ensemble.hpp"

namespace hamflow {

/// Makes a block. Returns null if the request cannot run in lanes; load() returns false if the members cannot.
std::unique_ptr<EnsembleBlock> make_iterated_block(const std::shared_ptr<const ProblemEntry>& problem,
                                                   const Request& request, LaneSet lanes);

}  // namespace hamflow
