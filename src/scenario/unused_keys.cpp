#include "unused_keys.hpp"

#include "hamflow/core/text.hpp"
#include "run_keys.hpp"

namespace hamflow {

std::vector<std::string> unused_measures(const Scenario& scenario, const std::string& why) {
  const RunKeys& keys = run_keys();
  std::vector<std::string> unused;
  if (scenario.lyapunov > 0) unused.push_back(run_path(keys.lyapunov));
  if (scenario.eigenvalues) unused.push_back(run_path(keys.eigenvalues));
  if (scenario.section) unused.push_back(run_path(keys.section));
  if (!scenario.events.empty()) unused.push_back(run_path(keys.events));
  if (unused.empty()) return {};
  return {joined(unused) + (unused.size() == 1 ? " is" : " are") + " not used: " + why};
}

std::vector<std::string> unused_figures(const Scenario& scenario, const std::string& why) {
  if (scenario.figures.empty()) return {};
  return {output_path(output_keys().figures) + " is not used: " + why};
}

}  // namespace hamflow
