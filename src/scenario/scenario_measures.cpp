// What a run is asked to measure beside its trajectory: run.lyapunov, run.eigenvalues, run.section.
#include <algorithm>

#include "scenario_reader.hpp"

namespace hamflow {

namespace {

/// q, q1, x: p, p1, p_x.
std::string momentum_name(const std::string& coordinate) {
  return coordinate.starts_with('q') ? "p" + coordinate.substr(1) : "p_" + coordinate;
}

/// The names that the problem gives them; q1, q2, ... of problems of any size.
std::vector<std::string> coordinate_names(const ProblemEntry& problem, std::size_t dimension) {
  std::vector<std::string> names = problem.info.coordinates;
  if (problem.dimension == 0) {
    names.clear();
    for (std::size_t i = 1; i <= dimension; ++i) names.push_back("q" + std::to_string(i));
  }
  return names;
}

}  // namespace

void ScenarioReader::read_measures(TomlTable& table) {
  const std::size_t dimension = scenario_.start_q.size();
  if (table.is_boolean("lyapunov")) {
    if (table.boolean("lyapunov").value_or(false)) scenario_.lyapunov = 2 * dimension;
  } else if (const auto count =
                 table.whole("lyapunov", 1, dimension > 0 ? static_cast<std::int64_t>(2 * dimension) : most_steps)) {
    scenario_.lyapunov = static_cast<std::size_t>(*count);
  } else if (table.has("lyapunov")) {
    complaints_.back().message += ", or true, false";
  }
  scenario_.eigenvalues = table.boolean("eigenvalues").value_or(false);
  for (const char* key : {"lyapunov", "eigenvalues"}) {
    if (!(key[0] == 'l' ? scenario_.lyapunov > 0 : scenario_.eigenvalues)) continue;
    if (scenario_.request.arithmetic != "double") {
      table.complain(key, table.found(key) + " with arithmetic \"" + scenario_.request.arithmetic +
                              "\"; allowed with arithmetic = \"double\": steps are differentiated in double");
    }
    if (scenario_.request.method.name == "cg" && scenario_.request.method.cg.halve) {
      table.complain(key, table.found(key) +
                              " with method.on_divergence = \"halve\"; allowed with \"error\": a step that was halved "
                              "is not differentiated");
    }
  }
  read_section(table);
}

void ScenarioReader::read_section(TomlTable& table) {
  if (!table.has("section")) {
    table.know("section");
    return;
  }
  TomlTable section = table.table("section");
  if (!section.exists()) return;  // told
  Section wanted;
  if (const auto value = section.number("value")) wanted.value = value->value;
  if (const auto direction = section.whole("direction", -1, 1)) wanted.direction = static_cast<int>(*direction);
  if (scenario_.problem == nullptr || scenario_.start_q.empty()) {
    (void)section.string("coordinate");
  } else {
    std::vector<std::string> names = coordinate_names(*scenario_.problem, scenario_.start_q.size());
    const std::size_t dimension = names.size();
    for (std::size_t i = 0; i < dimension; ++i) names.push_back(momentum_name(names[i]));
    if (!section.has("coordinate")) {
      section.know("coordinate");
      section.missing("coordinate", joined(names));
    } else if (const auto name = section.choice("coordinate", names)) {
      const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), *name) - names.begin());
      wanted.coordinate = at % dimension;
      wanted.momentum = at >= dimension;
      scenario_.section = wanted;
    }
  }
  section.finish();
}

}  // namespace hamflow
