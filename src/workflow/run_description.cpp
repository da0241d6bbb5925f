#include "run_description.hpp"

#include <unistd.h>

namespace hamflow {

std::vector<std::pair<std::string, std::size_t>> invariant_columns(const Scenario& scenario) {
  const std::vector<InvariantInfo>& declared = scenario.problem->info.invariants;
  const std::vector<std::size_t> sizes =
      scenario.problem->invariant_sizes(scenario.request.parameters, scenario.start_q.size());
  std::vector<std::pair<std::string, std::size_t>> all;
  for (std::size_t i = 0; i < declared.size(); ++i) all.emplace_back(declared[i].name, sizes[i]);
  return all;
}

RunDescription description_of(const Scenario& scenario, std::size_t samples) {
  return {.scenario = scenario.text,
          .version = HAMFLOW_VERSION,
          .host = host_name(),
          .problem = scenario.request.problem,
          .method = describe(scenario.request.method).name,
          .arithmetic = scenario.request.arithmetic,
          .kernel = scenario.request.kernel,
          .dimension = scenario.start_q.size(),
          .invariants = invariant_columns(scenario),
          .diagnostics = describe(scenario.request.method).diagnostics,
          .section = scenario.section.has_value(),
          .samples = samples};
}

std::string host_name() {
  char host[256] = "";
  (void)gethostname(host, sizeof host - 1);
  return host;
}

}  // namespace hamflow
