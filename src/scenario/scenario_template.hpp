// A complete scenario for a problem, with every key that it may have explained beside it.
#pragma once

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// What the catalogue itself does not say: a state and parameters that make a sensible run.
struct ScenarioExample {
  Texts parameters;       // those that differ from the defaults, or have none
  std::vector<double> q;  // empty: the problem has a start of its own
  std::vector<double> p;
  double dt = 0.05;
  std::int64_t steps = 1000;
};

/// TOML that can be read and run as it is. Of several starts the bounded one is active, the others stand as comments.
std::string scenario_template(const ProblemEntry& problem, const ScenarioExample& example);

}  // namespace hamflow
