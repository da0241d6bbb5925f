// What the walls of one run are, and what its functions and recorded steps become behind them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/erased.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

template <class R>
struct RunWalls {
  WallRule rule = WallRule::event;
  bool in_steps = false;      // a recorded step can take a bounce
  bool turns_single = false;  // a bounce is p_i -> -p_i and nothing else, for certain
  std::vector<WallSide<R>> sides;
  std::vector<std::string> names;  // of their coordinates
  std::shared_ptr<const Functions<R>> functions;
};

/// The walls of a request. Afterwards `run` has the functions behind them, and knows what its recorded steps do there.
template <class R>
std::shared_ptr<const RunWalls<R>> put_behind_walls(ErasedRun<R>& run, const Request& request, const Walls& walls);

}  // namespace hamflow
