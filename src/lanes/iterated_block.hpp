// A block of lanes made of simulations whose steps are solved by iteration.
#pragma once

#include <memory>

#include "hamflow/run/ensemble.hpp"

namespace hamflow {

/// Null where no lanes of such a request are known. load() is false where they cannot hand their steps over.
std::unique_ptr<EnsembleBlock> make_iterated_block(const std::shared_ptr<const ProblemEntry>& problem,
                                                   const Request& request, LaneSet lanes);

}  // namespace hamflow
