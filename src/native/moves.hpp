// Orders simultaneous moves so that they can be done one after the other.
#pragma once

#include <functional>

#include "registers.hpp"

namespace hamflow::native {

struct Move {
  Place from, to;
};

/// Appends lines with the effect of all moves at once. Targets are registers or homes, each at most once.
/// @param scratch a register that is not a target   @param new_slot returns an unused place on the stack
void append_moves(std::vector<Line>& lines, std::vector<Move> moves, std::uint32_t scratch,
                  const std::function<Place()>& new_slot);

}  // namespace hamflow::native
