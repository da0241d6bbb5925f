// The functions of a problem behind walls, where walls change them: soft walls are a term of V; by the rule "mirror" H
// goes on behind a wall as its mirror image; and invariants that walls break are none.
#pragma once

#include <optional>

#include "erased.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

/// While it lives, functions of this thread say here which soft interval was left.
class OutsideNote {
 public:
  explicit OutsideNote(std::optional<std::size_t>& interval);
  ~OutsideNote();
  OutsideNote(const OutsideNote&) = delete;
  OutsideNote& operator=(const OutsideNote&) = delete;
  static void note(std::size_t interval);

 private:
  std::optional<std::size_t>* before_;
};

/// @param sides of hard walls, as they stand in the run
template <class R>
ErasedFunctions<R> functions_behind_walls(const ErasedFunctions<R>& functions, const Request& request,
                                          const Walls& walls, const std::vector<WallSide<R>>& sides);

}  // namespace hamflow
