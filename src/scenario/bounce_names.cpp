#include "bounce_names.hpp"

#include "hamflow/run/state_names.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

std::vector<std::string> bounce_names(const Scenario& scenario) {
  const auto& walls = scenario.request.walls;
  if (!walls || !walls->hard()) return {};
  const StateNames names = state_names(*scenario.problem, scenario.request.parameters, scenario.start_q.size());
  const bool particles = static_cast<bool>(scenario.problem->particles);  // all particles have the same walls
  std::vector<std::string> all;
  for (const WallSide<double>& wall : wall_sides<double>(*walls)) {
    const std::string& coordinate = names.q.at(wall.coordinate);
    all.push_back("wall:" + (particles ? coordinate.substr(0, 1) : coordinate) + (wall.side < 0 ? ":min" : ":max"));
  }
  return all;
}

}  // namespace hamflow
