// Walls around any simulation: what is behind virtual calls takes its steps in parts (detail/run/steps_in_parts.hpp),
// and no method or problem knows of them. Compiled once for each number type.
#pragma once

#include "engine/erased.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

template <class R>
using Simulate = std::unique_ptr<Simulation> (*)(const ErasedRun<R>&, const Request&);

/// The simulation of a request behind the walls.
/// @param simulate without them
template <class R>
std::unique_ptr<Simulation> simulate_behind_walls(const ErasedRun<R>& run, const Request& request, const Walls& walls,
                                                  Simulate<R> simulate);

}  // namespace hamflow
