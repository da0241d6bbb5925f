// [problem]: which one, its parameters, where it starts.
#include <algorithm>

#include "scenario_reader.hpp"

namespace hamflow {

namespace {
std::vector<std::string> problem_names() {
  std::vector<std::string> names;
  for (const ProblemEntry& entry : problems()) {
    if (std::find(names.begin(), names.end(), entry.info.name) == names.end()) names.push_back(entry.info.name);
  }
  return names;
}
}  // namespace

void ScenarioReader::read_problem(TomlTable& table) {
  if (!table.has("name")) {
    table.missing("name", joined(problem_names()));
    return;
  }
  const auto name = table.choice("name", problem_names());
  if (!name) {
    const std::string meant = nearest(table.string("name").value_or(""), problem_names());
    if (!meant.empty()) read_uncertain(table, meant);
    return;
  }
  scenario_.request.problem = *name;
  read_variant(table, *name);
  if (scenario_.problem == nullptr) {
    read_uncertain(table, *name);
    return;
  }
  const std::size_t before = complaints_.size();
  const ProblemInfo& info = scenario_.problem->info;
  for (const ParameterInfo& parameter : info.parameters) {
    if (const auto value = read_parameter(table, parameter)) scenario_.request.parameters[parameter.name] = *value;
  }
  scenario_.request.parameters = complete(info, scenario_.request.parameters);
  if (!info.starts.empty()) read_orbit(table);
  read_initial(table);
  table.finish();
  if (complaints_.size() == before) check_start(table);
}

std::optional<std::string> ScenarioReader::read_parameter(TomlTable& table, const ParameterInfo& parameter) {
  const auto value = table.number(parameter.name);
  if (!value) return std::nullopt;
  const bool positive = parameter.range == Range::positive;
  if (positive ? !(value->value > 0) : parameter.range == Range::not_negative && value->value < 0) {
    table.complain(parameter.name, table.found(parameter.name) + "; allowed a " +
                                       (positive ? "positive number (" : "number not below 0 (") + parameter.meaning +
                                       ")");
  }
  return value->text;
}

/// The variant or the name is wrong, which has been said; what else is wrong whatever was meant is told at once.
void ScenarioReader::read_uncertain(TomlTable& table, const std::string& name) {
  std::vector<std::string> seen;
  std::vector<std::string> kinds;
  std::vector<std::string> orbit_keys{"direction"};
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name != name) continue;
    for (const auto& choice : entry.info.variant) table.know(choice.first);
    for (const ParameterInfo& parameter : entry.info.parameters) {
      if (std::find(seen.begin(), seen.end(), parameter.name) != seen.end()) continue;
      seen.push_back(parameter.name);
      (void)read_parameter(table, parameter);
    }
    for (const StartInfo& start : entry.info.starts) {
      if (std::find(kinds.begin(), kinds.end(), start.kind) == kinds.end()) kinds.push_back(start.kind);
      orbit_keys.insert(orbit_keys.end(), start.keys.begin(), start.keys.end());
    }
  }
  table.know_all({"name", "initial"});
  if (!kinds.empty() && table.has("orbit")) {
    TomlTable orbit = table.table("orbit");
    (void)orbit.choice("kind", kinds);
    for (const std::string& key : orbit_keys) {
      if (orbit.has(key)) (void)orbit.number(key);
    }
    orbit.know_all(orbit_keys);
    orbit.finish();
  }
  table.know("orbit");
  table.finish();
}

void ScenarioReader::read_variant(TomlTable& table, const std::string& name) {
  // The choices of each selecting key, from the entries that carry the name.
  std::vector<std::string> keys;
  std::map<std::string, std::vector<std::string>> choices;
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name != name) continue;
    for (const auto& [key, value] : entry.info.variant) {
      if (!choices.contains(key)) keys.push_back(key);
      auto& list = choices[key];
      if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
    }
  }
  bool complete_choice = true;
  for (const std::string& key : keys) {
    if (!table.has(key)) {
      table.know(key);
      if (key == "coordinates") {  // cartesian unless said otherwise
        scenario_.request.variant[key] = "cartesian";
      } else {
        table.missing(key, joined(choices[key]));
        complete_choice = false;
      }
      continue;
    }
    const auto chosen = table.choice(key, choices[key]);
    if (chosen) {
      scenario_.request.variant[key] = *chosen;
    } else {
      complete_choice = false;
    }
  }
  if (!complete_choice) return;
  try {
    scenario_.problem = &find_problem(name, scenario_.request.variant);
  } catch (const Error& error) {
    table.complain("name", error.what());
  }
}

void ScenarioReader::read_orbit(TomlTable& table) {
  if (!table.has("orbit")) {
    table.know("orbit");
    return;
  }
  TomlTable orbit = table.table("orbit");
  if (!orbit.exists()) return;
  const ProblemInfo& info = scenario_.problem->info;
  std::vector<std::string> kinds;
  for (const StartInfo& start : info.starts) kinds.push_back(start.kind);
  if (!orbit.has("kind")) {
    orbit.missing("kind", joined(kinds));
    return;
  }
  const auto kind = orbit.choice("kind", kinds);
  if (!kind) return;
  const StartInfo& start =
      info.starts[static_cast<std::size_t>(std::find(kinds.begin(), kinds.end(), *kind) - kinds.begin())];
  StartSpec& spec = scenario_.request.start;
  for (const std::string& key : start.keys) {
    if (!orbit.has(key)) {
      orbit.know(key);
      orbit.missing(key, "a number: the start \"" + *kind + "\" takes exactly " + joined(start.keys));
      continue;
    }
    const auto value = orbit.number(key);
    if (value) spec.orbit[key] = value->text;
  }
  if (const auto direction = orbit.number("direction")) {
    if (direction->value != 1 && direction->value != -1)
      orbit.complain("direction", orbit.found("direction") + "; allowed 1, -1");
    spec.direction = direction->value < 0 ? -1 : 1;
  }
  orbit.finish();
  for (const std::string& parameter : start.derives) {
    if (!table.has(parameter)) continue;
    table.complain(parameter, table.found(parameter) +
                                  ", but it follows from the orbit; allowed nothing with kind = \"" + *kind + "\"");
  }
  spec.kind = *kind;
}

void ScenarioReader::read_initial(TomlTable& table) {
  const ProblemEntry& problem = *scenario_.problem;
  StartSpec& spec = scenario_.request.start;
  if (!table.has("initial")) {
    table.know("initial");
    if (!spec.kind.empty() || table.has("orbit")) return;
    if (!problem.info.default_q.empty()) {
      spec.q = problem.info.default_q;
      spec.p = problem.info.default_p;
      return;
    }
    table.missing("initial", std::string(problem.info.starts.empty() ? "" : "orbit = { kind, ... } or ") +
                                 "initial = { q = [...], p = [...] } with " + std::to_string(problem.dimension) +
                                 (problem.dimension == 1 ? " number each" : " numbers each") +
                                 ", or { q, v } with velocities");
    return;
  }
  TomlTable initial = table.table("initial");
  if (!initial.exists()) return;
  if (!initial.has("q")) initial.missing("q", "an array of " + std::to_string(problem.dimension) + " numbers");
  if (initial.has("p") == initial.has("v")) {
    initial.complain(initial.has("p") ? "v" : "p", initial.has("p") ? "found p and v together; allowed one of them"
                                                                    : "found neither p nor v; allowed one of them");
  }
  const auto q = initial.numbers("q", problem.dimension);
  const auto p = initial.numbers("p", problem.dimension);
  const auto v = initial.numbers("v", problem.dimension);
  initial.finish();
  spec.kind.clear();  // a state overrides a geometric start
  spec.q = q.value_or(std::vector<std::string>{});
  spec.p = p.value_or(std::vector<std::string>{});
  spec.v = v.value_or(std::vector<std::string>{});
}

void ScenarioReader::check_start(TomlTable& table) {
  const ProblemEntry& problem = *scenario_.problem;
  const Request& request = scenario_.request;
  const bool geometric = !request.start.kind.empty();
  bool possible = true;
  if (geometric) {
    scenario_.request.parameters = problem.derived(request.parameters, request.start);
    for (const Condition& condition : problem.conditions(request.parameters, request.start)) {
      if (condition.holds()) continue;
      possible = false;
      // The key to blame is dotted from the root; complain where it stands.
      const std::string inside = condition.key.substr(std::string("problem.").size());
      const bool in_orbit = inside.starts_with("orbit.");
      TomlTable at = in_orbit ? table.table("orbit") : table;
      const std::string key = in_orbit ? inside.substr(6) : inside;
      at.complain(key, at.found(key) + "; allowed " + condition.statement + ", but " + shortest(condition.left) +
                           (condition.strict ? " >= " : " > ") + shortest(condition.right) + ": fails by " +
                           shortest(condition.left - condition.right));
    }
  }
  if (!possible) return;
  const Frame start = problem.start(request);
  scenario_.start_q = start.q;
  scenario_.start_p = start.p;
  if (!problem.regular(request.parameters, start.q, start.p)) {
    table.complain(
        geometric ? "orbit" : "initial",
        "found a start where H or its derivatives are not finite; allowed a regular point of " + problem.info.formula);
  }
}

}  // namespace hamflow
