#include "bounce_names.hpp"

#include "hamflow/run/gas.hpp"
#include "hamflow/run/state_names.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

std::vector<std::string> bounce_names(const Scenario& scenario) {
  const auto& walls = scenario.request.walls;
  if (!walls || !walls->hard()) return {};
  const StateNames names = state_names(*scenario.problem, scenario.request.parameters, scenario.start_q.size());
  const bool gas = scenario.request.problem == GasKeys::problem;
  std::vector<std::string> all;
  for (const WallSide<double>& wall : wall_sides<double>(*walls)) {
    const std::string& coordinate = names.q.at(wall.coordinate);
    all.push_back("wall:" + (gas ? coordinate.substr(0, 1) : coordinate) + (wall.side < 0 ? ":min" : ":max"));
  }
  return all;
}

}  // namespace hamflow
