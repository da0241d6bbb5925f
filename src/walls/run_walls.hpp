// The walls of a run, and its functions and recorded steps with walls.
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
  bool turns_single = false;  // a bounce is certainly only p_i -> -p_i
  std::vector<WallSide<R>> sides;
  std::vector<std::string> names;  // names of their coordinates
  std::shared_ptr<const Functions<R>> functions;
};

/// Makes the walls of a request. `run` receives the functions with walls and the rule for its recorded steps.
template <class R>
std::shared_ptr<const RunWalls<R>> add_walls_to_run(ErasedRun<R>& run, const Request& request, const Walls& walls);

}  // namespace hamflow
