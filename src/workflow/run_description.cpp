#include "run_description.hpp"

#include <unistd.h>

#include <algorithm>

#include "element_columns.hpp"
#include "gas/container.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/detail/problems/solar_bodies.hpp"
#include "hamflow/detail/run/digits.hpp"
#include "hamflow/run/state_names.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

namespace {

bool is_solar_system(const Scenario& scenario) { return scenario.request.problem == SolarBodies::problem; }

/// Returns the masses of the bodies in order; one entry if the problem has one mass.
std::vector<double> masses_of(const Scenario& scenario) {
  const Parameters<double> parameters(scenario.request.parameters);
  for (const char* name : {"masses", "mass"}) {
    if (parameters.has(name)) return parameters.list(name);
  }
  if (!is_solar_system(scenario)) return {};
  return solar_bodies(choice_of(scenario.problem->info, SolarBodies::key)).masses<double>();
}

/// Units of columns: those of the numbers of the solar system, or those that [problem].units names; else those of the
/// input, which has no names.
struct Units {
  std::string length, momentum, angular_momentum;
  ColumnUnits columns{};
};
Units units_of(const Scenario& scenario) {
  const UnitNames names = is_solar_system(scenario) ? UnitNames{"AU", "day", "solar mass"} : scenario.units;
  if (names.length.empty()) return {};
  const std::string head = names.mass + " " + names.length;
  return {
      names.length,
      head + "/" + names.time,
      head + "^2/" + names.time,
      {.t = names.time, .q = names.length, .p = head + "/" + names.time, .energy = head + "^2/" + names.time + "^2"}};
}

std::string unit_of(const InvariantInfo& invariant, const Units& units) {
  switch (invariant.terms) {
    case Terms::moments:
      return units.angular_momentum;
    case Terms::momentum:
    case Terms::momenta:
      return units.momentum;
    case Terms::centre_of_mass:
      return units.length;
    case Terms::other:
      break;
  }
  return "";
}

/// Returns the data of a gas for the H5MD groups; empty for other problems.
H5mdParticles particles_of(const Scenario& scenario) {
  H5mdParticles all;
  const ProblemEntry& problem = *scenario.problem;
  if (!problem.particles) return all;
  ParticleFacts particles = problem.particles(scenario.request.parameters);
  all.space = particles.space;
  all.masses = std::move(particles.masses);
  all.masses.resize(scenario.start_q.size() / all.space, all.masses.front());
  all.boundary.assign(all.space, problem.container == ContainerNames::periodic ? "periodic" : "none");
  all.edges = std::move(particles.edges);
  if (particles.radius > 0) all.edges.assign(all.space, 2 * particles.radius);
  all.author = author_name();
  all.time_grows = scenario.dt > 0;
  const bool start_is_a_sample =
      scenario.record.empty() || (scenario.record_steps.front() == 0 && number_value(scenario.record.front()) == 0);
  if (!start_is_a_sample) {
    all.start_q = scenario.start_q;
    all.start_p = scenario.start_p;
  }
  return all;
}

std::vector<std::string> event_names(const Scenario& scenario) {
  std::vector<std::string> all;
  for (const UserEvent& event : scenario.events) all.push_back(event.name);
  return all;
}

}  // namespace

std::vector<InvariantColumn> invariant_columns(const Scenario& scenario) {
  const std::vector<InvariantInfo>& declared = scenario.problem->info.invariants;
  const std::vector<std::size_t> sizes =
      scenario.problem->invariant_sizes(scenario.request.parameters, scenario.start_q.size());
  std::vector<InvariantColumn> all;
  for (std::size_t i = 0; i < declared.size(); ++i) {
    all.push_back({declared[i].name, sizes[i], declared[i].meaning, unit_of(declared[i], units_of(scenario))});
  }
  return all;
}

std::vector<InvariantColumn> observable_columns(const Scenario& scenario) {
  std::vector<InvariantColumn> all;
  for (const NamedExpression& each : scenario.observables) all.push_back({each.name, 1, each.expression.text(), {}});
  if (scenario.hamiltonian) {
    all.push_back({scenario.hamiltonian->name, 1, "H(q, p, t), including the work of the drive", {}});
  }
  if (scenario.elements) {
    for (const std::size_t body : bodies_with_elements(scenario)) {
      for (const ElementColumn& column : element_columns()) {
        const std::string unit = column.quantity == ElementColumn::Quantity::length  ? units_of(scenario).length
                                 : column.quantity == ElementColumn::Quantity::time  ? units_of(scenario).columns.t
                                 : column.quantity == ElementColumn::Quantity::angle ? "rad"
                                                                                     : "";
        all.push_back({body_name(scenario, body) + "." + column.name, 1, column.meaning, unit});
      }
    }
  }
  return all;
}

std::vector<double> observable_values(const Scenario& scenario, const Frame& frame) {
  std::vector<double> all;
  for (const NamedExpression& each : scenario.observables) all.push_back(each.expression(frame));
  if (scenario.hamiltonian) all.push_back(scenario.hamiltonian->expression(frame));
  if (scenario.elements) {
    const auto elements = elements_at(scenario, frame);
    for (const std::size_t body : bodies_with_elements(scenario)) {
      for (const ElementColumn& column : element_columns()) all.push_back((*elements[body]).*column.value);
    }
  }
  return all;
}

std::vector<InvariantColumn> csv_columns(const Scenario& scenario) {
  std::vector<InvariantColumn> all = invariant_columns(scenario);
  for (InvariantColumn& each : observable_columns(scenario)) all.push_back(std::move(each));
  return all;
}

ColumnUnits column_units(const Scenario& scenario) { return units_of(scenario).columns; }

std::vector<std::string> changes_during_run(std::string_view scenario) {
  std::vector<std::string> changes;
  if (!scenario.starts_with(session_heading)) return changes;
  for (scenario.remove_prefix(session_heading.size()); scenario.starts_with(change_heading);) {
    const std::string_view line = scenario.substr(0, scenario.find('\n'));
    changes.emplace_back(line.substr(line.find(": ") + 2));
    scenario.remove_prefix(std::min(line.size() + 1, scenario.size()));
  }
  return changes;
}

RunDescription description_of(const Scenario& scenario, std::size_t samples) {
  const Request& request = scenario.request;
  const MethodInfo method = describe(request.method);
  H5mdParticles particles = particles_of(scenario);
  // For very many particles the list of names would need as much space as a sample.
  const bool named = particles.space == 0 || scenario.start_q.size() <= most_named_coordinates;
  const StateNames names =
      named ? state_names(*scenario.problem, request.parameters, scenario.start_q.size()) : StateNames{};
  return {.scenario = scenario.text,
          .version = HAMFLOW_VERSION,
          .host = host_name(),
          .problem = request.problem,
          .method = method.name,
          .arithmetic = request.arithmetic,
          .dimension = scenario.start_q.size(),
          .invariants = invariant_columns(scenario),
          .observables = observable_columns(scenario),
          .diagnostics = method.diagnostics,
          .energy_range = scenario.record_every > 1 || !scenario.record.empty(),
          .section = scenario.section.has_value(),
          .walls = has_hard_walls(request),
          .events = event_names(scenario),
          .samples = samples,
          .dt = scenario.dt,
          .dt_text = request.dt,
          .coordinates = names.q,
          .momenta = names.p,
          .masses = named ? masses_of(scenario) : std::vector<double>(),
          .particles = std::move(particles),
          .units = units_of(scenario).columns,
          .digits_length = longest_digits(request.arithmetic)};
}

void check_states(const Scenario& scenario, const RunDescription& found, const std::filesystem::path& file) {
  if (found.dimension == scenario.start_q.size()) return;
  throw FileError(file.string() + " is damaged: its states have " + std::to_string(found.dimension) +
                  " coordinates, but its scenario has " + std::to_string(scenario.start_q.size()));
}

std::string host_name() {
  char host[256] = "";
  (void)gethostname(host, sizeof host - 1);
  return host;
}

}  // namespace hamflow
