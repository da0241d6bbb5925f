// The functions of a problem with walls. Soft walls are a term of V; with the rule "mirror", H continues beyond a wall
// as its mirror image; invariants that walls break are removed.
#pragma once

#include "core/outside_note.hpp"
#include "engine/erased.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

/// @param sides hard walls of the run
template <class R>
ErasedFunctions<R> functions_with_walls(const ErasedFunctions<R>& functions, const Request& request, const Walls& walls,
                                        const std::vector<WallSide<R>>& sides);

}  // namespace hamflow
