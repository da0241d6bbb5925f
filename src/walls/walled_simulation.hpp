// Walls around any simulation behind virtual calls that supports partial steps (detail/run/steps_in_parts.hpp). Methods
// and problems do not know about walls. Compiled once for each number type.
#pragma once

#include "engine/erased.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

template <class R>
using Simulate = std::unique_ptr<Simulation> (*)(const ErasedRun<R>&, const Request&);

/// The simulation of a request with walls.
/// @param simulate makes the simulation without walls
template <class R>
std::unique_ptr<Simulation> simulate_with_walls(const ErasedRun<R>& run, const Request& request, const Walls& walls,
                                                Simulate<R> simulate);

}  // namespace hamflow
