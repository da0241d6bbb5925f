// Many moves that happen at once, one after the other.
#pragma once

#include <functional>

#include "registers.hpp"

namespace hamflow::native {

struct Move {
  Place from, to;
};

/// Appends to `lines` what has the effect of all moves at once; every target stands once. Targets are registers or
/// homes. @param scratch a register that is no target
/// @param new_slot a place on the stack that nothing else uses
void append_moves(std::vector<Line>& lines, std::vector<Move> moves, std::uint32_t scratch,
                  const std::function<Place()>& new_slot);

}  // namespace hamflow::native
