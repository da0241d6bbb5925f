#include "run_description.hpp"

#include <unistd.h>

#include "hamflow/run/digits.hpp"
#include "hamflow/run/state_names.hpp"

namespace hamflow {

namespace {

/// Of the bodies, one after the other; a problem that has one mass has one.
std::vector<double> masses_of(const Scenario& scenario) {
  const Parameters<double> parameters(scenario.request.parameters);
  for (const char* name : {"masses", "mass"}) {
    if (parameters.has(name)) return parameters.list(name);
  }
  return {};
}

}  // namespace

std::vector<InvariantColumn> invariant_columns(const Scenario& scenario) {
  const std::vector<InvariantInfo>& declared = scenario.problem->info.invariants;
  const std::vector<std::size_t> sizes =
      scenario.problem->invariant_sizes(scenario.request.parameters, scenario.start_q.size());
  std::vector<InvariantColumn> all;
  for (std::size_t i = 0; i < declared.size(); ++i) {
    all.push_back({declared[i].name, sizes[i], declared[i].meaning, {}});
  }
  return all;
}

std::vector<InvariantColumn> observable_columns(const Scenario& scenario) {
  std::vector<InvariantColumn> all;
  for (const NamedExpression& each : scenario.observables) all.push_back({each.name, 1, each.expression.text(), {}});
  return all;
}

std::vector<double> observable_values(const Scenario& scenario, const Frame& frame) {
  std::vector<double> all;
  for (const NamedExpression& each : scenario.observables) all.push_back(each.expression(frame));
  return all;
}

std::vector<InvariantColumn> csv_columns(const Scenario& scenario) {
  std::vector<InvariantColumn> all = invariant_columns(scenario);
  for (InvariantColumn& each : observable_columns(scenario)) all.push_back(std::move(each));
  return all;
}

RunDescription description_of(const Scenario& scenario, std::size_t samples) {
  const Request& request = scenario.request;
  const MethodInfo method = describe(request.method);
  const StateNames names = state_names(*scenario.problem, request.parameters, scenario.start_q.size());
  return {.scenario = scenario.text,
          .version = HAMFLOW_VERSION,
          .host = host_name(),
          .problem = request.problem,
          .method = method.name,
          .arithmetic = request.arithmetic,
          .kernel = request.kernel,
          .dimension = scenario.start_q.size(),
          .invariants = invariant_columns(scenario),
          .observables = observable_columns(scenario),
          .diagnostics = method.diagnostics,
          .section = scenario.section.has_value(),
          .walls = has_hard_walls(request),
          .samples = samples,
          .dt = scenario.dt,
          .dt_text = request.dt,
          .coordinates = names.q,
          .momenta = names.p,
          .masses = masses_of(scenario),
          .digits_length = longest_digits(request.arithmetic)};
}

std::string host_name() {
  char host[256] = "";
  (void)gethostname(host, sizeof host - 1);
  return host;
}

}  // namespace hamflow
