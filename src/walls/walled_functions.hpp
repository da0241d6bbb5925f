// The functions of a problem behind walls, where walls change them: soft walls are a term of V; by the rule "mirror" H
// goes on behind a wall as its mirror image; and invariants that walls break are none.
#pragma once

#include "core/outside_note.hpp"
#include "engine/erased.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

/// @param sides of hard walls, as they stand in the run
template <class R>
ErasedFunctions<R> functions_behind_walls(const ErasedFunctions<R>& functions, const Request& request,
                                          const Walls& walls, const std::vector<WallSide<R>>& sides);

}  // namespace hamflow
