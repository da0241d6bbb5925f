// Reads the start in [problem]: an orbit, a numbered case or a state.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/walls.hpp"
#include "scenario_reader.hpp"
#include "start_keys.hpp"
#include "toml_path.hpp"

namespace hamflow {

/// Reads `case = 1` and the keys of that start.
void ScenarioReader::read_numbered_start(TomlTable& table) {
  const ProblemInfo& info = scenario_.problem->info;
  const auto number =
      table.whole({.name = info.start_key, .range = Range::whole_from(1, static_cast<double>(info.starts.size()))});
  std::vector<std::string> of_this;
  if (number) {
    const StartInfo& start = info.starts[static_cast<std::size_t>(*number - 1)];
    of_this = start.keys;
    for (const std::string& key : start.keys) {
      if (const auto value = table.text(number_key(key))) scenario_.request.start.orbit[key] = *value;
      if (!table.has(key))
        table.missing(key, "a number: " + info.start_key + " = " + std::to_string(*number) + " takes exactly " +
                               joined(start.keys));
    }
    refuse_derived(table, start, info.start_key + " = " + std::to_string(*number));
    scenario_.request.start.kind = start.kind;
  }
  for (const StartInfo& start : info.starts) {
    for (const std::string& key : start.keys) {
      table.know(key);
      if (!table.has(key) || std::find(of_this.begin(), of_this.end(), key) != of_this.end()) continue;
      if (table.has(info.start_key) && !number) continue;  // which case is meant is unknown
      const std::string message = table.found(key) + "; allowed only with " + info.start_key + " = ...";
      if (!table.has(info.start_key)) table.complain(key, message);
      if (number) table.complain(key, table.found(key) + "; allowed with this case: " + joined(of_this));
      of_this.push_back(key);  // prevents a second complaint
    }
  }
}

void ScenarioReader::refuse_derived(TomlTable& table, const StartInfo& start, const std::string& because) {
  for (const std::string& parameter : start.derives) {
    if (!table.has(parameter)) continue;
    table.complain(parameter, table.found(parameter) + ", but it follows from the orbit; leave it out with " + because);
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
  const StartInfo* by_keys = nullptr;  // the start without a kind, which its keys identify
  for (const StartInfo& start : info.starts) {
    if (start.kind.empty()) {
      by_keys = &start;
    } else {
      kinds.push_back(start.kind);
    }
  }
  const StartInfo* start = nullptr;
  const bool has_these = by_keys != nullptr && std::all_of(by_keys->keys.begin(), by_keys->keys.end(),
                                                           [&](const std::string& key) { return orbit.has(key); });
  if (!orbit.has("kind")) {
    if (!has_these && kinds.empty() && by_keys != nullptr) {
      for (const std::string& key : by_keys->keys) {
        orbit.know(key);
        if (!orbit.has(key)) orbit.missing(key, "a number: a start takes " + joined(by_keys->keys) + " together");
      }
      orbit.know("direction");
      orbit.finish();
      return;
    }
    if (!has_these) {
      orbit.missing("kind", joined(kinds) + (by_keys == nullptr ? ""
                                                                : (kinds.empty() ? "" : "; or, without kind, ") +
                                                                      joined(by_keys->keys)));
      for (const StartInfo& any : info.starts) orbit.know_all(any.keys);
      orbit.know("direction");
      orbit.finish();
      return;
    }
    orbit.know("kind");
    start = by_keys;
  } else {
    if (kinds.empty()) {
      orbit.complain("kind",
                     orbit.found("kind") + "; allowed without: " +
                         (by_keys == nullptr ? "this problem has no orbits by geometry" : joined(by_keys->keys)));
      for (const StartInfo& any : info.starts) orbit.know_all(any.keys);
      orbit.know("kind");
      orbit.know("direction");
      orbit.finish();
      return;
    }
    const auto kind = orbit.text(kind_key(kinds));
    if (!kind) return;
    start =
        &*std::find_if(info.starts.begin(), info.starts.end(), [&](const StartInfo& one) { return one.kind == *kind; });
  }
  StartSpec& spec = scenario_.request.start;
  const std::string because = start->kind.empty() ? "energy and angular_momentum" : "kind = \"" + start->kind + "\"";
  for (const std::string& key : start->keys) {
    if (!orbit.has(key)) {
      orbit.know(key);
      orbit.missing(key, "a number: the start \"" + start->kind + "\" takes exactly " + joined(start->keys));
      continue;
    }
    if (const auto value = orbit.text(number_key(key))) spec.orbit[key] = *value;
  }
  if (const auto direction = orbit.number(number_key("direction"))) {
    if (*direction != 1 && *direction != -1) orbit.complain("direction", orbit.found("direction") + "; allowed 1, -1");
    spec.direction = *direction < 0 ? -1 : 1;
  }
  orbit.finish();
  refuse_derived(table, *start, because);
  spec.kind = start->kind;
}

void ScenarioReader::read_initial(TomlTable& table) {
  const ProblemEntry& problem = *scenario_.problem;
  StartSpec& spec = scenario_.request.start;
  const std::string numbers = problem.dimension == 0   ? "as many numbers as there are coordinates"
                              : problem.dimension == 1 ? "1 number each"
                                                       : std::to_string(problem.dimension) + " numbers each";
  const OptionInfo& velocities = problem.info.velocities;
  const auto given = velocities.name.empty() ? std::nullopt : table.text(velocities);
  if (given && table.has(velocities.name) && table.has("initial")) {
    table.complain(velocities.name, table.found(velocities.name) + " together with initial; allowed one of them");
    table.know("initial");
    return;
  }
  if (!table.has("initial")) {
    table.know("initial");
    if (!spec.q.empty()) return;  // the start of a gas has been read already
    if (spec.geometric() || table.has("orbit") || table.has("bodies")) return;
    if (!problem.info.start_key.empty() && table.has(problem.info.start_key)) return;
    if (!problem.info.default_q.empty()) {
      spec.q = problem.info.default_q;
      spec.p = problem.info.default_p;
      if (!velocities.name.empty()) spec.v = list_parts(given.value_or(velocities.default_value));
      if (const auto& places = problem.info.velocity_places; !places.empty()) {
        const std::vector<std::string> some = std::exchange(spec.v, std::vector<std::string>(spec.q.size(), "0"));
        for (std::size_t i = 0; i < places.size() && i < some.size(); ++i) spec.v[places[i]] = some[i];
      }
      return;
    }
    table.missing("initial", std::string(problem.info.starts.empty()      ? ""
                                         : problem.info.start_key.empty() ? "orbit = { kind, ... } or "
                                                                          : problem.info.start_key + " = 1, ... or ") +
                                 "initial = { q = [...], p = [...] } with " + numbers +
                                 ", or { q, v } with velocities");
    return;
  }
  TomlTable initial = table.table("initial");
  if (!initial.exists()) return;
  if (initial.has("p") == initial.has("v")) {
    initial.complain(initial.has("p") ? "v" : "p", initial.has("p") ? "found p and v together; allowed one of them"
                                                                    : "found neither p nor v; allowed one of them");
  }
  const auto texts = [&](const OptionInfo& list) { return initial.numbers(list).value_or(std::vector<std::string>{}); };
  for (const std::string& other : {std::string("orbit"), problem.info.start_key}) {
    if (other.empty() || !table.has(other)) continue;
    table.complain("initial", "found together with " + other + "; allowed one of them");
    return;
  }
  spec.q = texts(list_key("q", problem.dimension));
  spec.p = texts(open_list_key("p", problem.dimension));
  spec.v = texts(open_list_key("v", problem.dimension));
  read_start_energy(initial);
  initial.finish();
}

/// Reads `energy`. Exactly one component of the state must then be "+" or "-" and is computed from it.
void ScenarioReader::read_start_energy(TomlTable& initial) {
  StartSpec& spec = scenario_.request.start;
  const OptionInfo key = number_key("energy");
  const std::string list = spec.v.empty() ? "p" : "v";
  const std::vector<std::string>& given = spec.v.empty() ? spec.p : spec.v;
  const auto open = std::count_if(given.begin(), given.end(), is_left_to_energy);
  const auto energy = initial.text(key);
  if (open > 1) {
    initial.complain(list, "found " + std::to_string(open) + " components \"+\" or \"-\"; allowed one");
  } else if (open == 1 && !initial.has(key.name)) {
    initial.missing(key.name,
                    "a number: the value of H from which the component \"+\" or \"-\" of " + list + " is computed");
  } else if (open == 0 && energy && !given.empty()) {
    initial.complain(key.name, "found together with all components of " + list + "; allowed if one of them is \"+\", " +
                                   "the largest root of H = energy, or \"-\", the smallest");
  }
  if (open == 1 && energy) spec.energy = *energy;
}

/// Reads the frame of bodies. A start by `initial` is used as given, unless the scenario says otherwise.
void ScenarioReader::read_frame(TomlTable& table) {
  const OptionInfo& key = scenario_.problem->info.frame;
  if (key.name.empty()) return;
  const auto frame = table.text(key);
  const std::string usual = table.has("initial")  ? StartFrames::given
                            : table.has("bodies") ? StartFrames::barycentric
                                                  : key.default_value;
  scenario_.request.start.barycentric = frame.value_or(usual) == StartFrames::barycentric;
}

/// Checks the size of a problem whose size follows from the start.
bool ScenarioReader::check_size(TomlTable& table) {
  const StartSpec& spec = scenario_.request.start;
  if (spec.geometric()) return true;
  const std::size_t before = complaints_.size();
  if (!table.has("initial") && scenario_.problem->particles) return check_masses(table);
  TomlTable at = table.has("initial") ? table.table("initial") : table;
  const auto check = [&](const char* key, std::size_t size) {
    const std::string why_not = scenario_.problem->refused_size(scenario_.request.parameters, size);
    if (!why_not.empty()) at.complain(key, "found " + std::to_string(size) + " entries; allowed " + why_not);
  };
  check("q", spec.q.size());
  const char* const other = spec.v.empty() ? "p" : "v";
  const std::size_t size = spec.v.empty() ? spec.p.size() : spec.v.size();
  check(other, size);
  if (complaints_.size() == before && size != spec.q.size()) {
    at.complain(other, "found " + std::to_string(size) + " entries; allowed " + std::to_string(spec.q.size()) +
                           ", the number of entries of q");
  }
  return complaints_.size() == before;
}

void ScenarioReader::check_start(TomlTable& table) {
  const ProblemEntry& problem = *scenario_.problem;
  const Request& request = scenario_.request;
  const bool geometric = request.start.geometric();
  if (!check_size(table)) return;
  bool possible = true;
  if (geometric) {
    scenario_.request.parameters = problem.derived(request.parameters, request.start);
    std::vector<Condition> conditions;
    try {
      conditions = problem.conditions(request.parameters, request.start);
    } catch (const Error& error) {
      table.complain("orbit", error.what());
      return;
    }
    for (const Condition& condition : conditions) {
      if (condition.holds()) continue;
      possible = false;
      // The key of a condition is a path from the root. The table that contains the key makes the complaint.
      const std::string inside = condition.key.substr(std::string("problem.").size());
      const bool in_orbit = inside.starts_with("orbit.");
      TomlTable at = in_orbit ? table.table("orbit") : table;
      const std::string key = in_orbit ? inside.substr(6) : inside;
      const double excess = condition.left - condition.right;
      at.complain(key, at.found(key) + "; allowed " + condition.statement + ", but " + shortest(condition.left) +
                           (condition.strict ? " >= " : " > ") + shortest(condition.right) +
                           (excess > 0 ? ", exceeded by " + shortest(excess) : ""));
    }
  }
  if (!possible) return;
  if (geometric) {
    const std::size_t before = complaints_.size();
    for (const StartInfo& start : problem.info.starts) {
      if (start.kind != request.start.kind) continue;
      for (const std::string& name : start.derives) {
        if (!request.parameters.at(name).empty()) continue;
        table.complain("name", "found a start that makes " + name + " infinite; allowed smaller numbers");
      }
    }
    check_parameters(table, true);
    if (complaints_.size() != before) return;
  }
  Frame start;
  try {
    start = problem.start(request);
  } catch (const NoStart& none) {
    no_start_ = none.what();
    TomlTable initial = table.table("initial");
    initial.complain("energy", initial.found("energy") + ", but " + none.what());
    return;
  } catch (const Error& error) {
    table.complain(table.has("initial") ? "initial" : "orbit", error.what());
    return;
  }
  scenario_.start_q = start.q;
  scenario_.start_p = start.p;
  if (geometric && request.start.kind.empty() && request.start.orbit.contains("energy")) {
    const double wanted = evaluate_number<double>(request.start.orbit.at("energy"));
    // An orbit belongs to the problem without walls.
    const double found = find_problem(request.problem, request.variant)->energy(request.parameters, start.q, start.p);
    double size = std::abs(wanted) + std::abs(found);
    for (const double p : start.p) size += p * p;
    if (!(std::abs(found - wanted) <= 1e-8 * size)) {
      table.complain("orbit", "a start with this energy cannot be represented in double; give initial = { q, p }");
      return;
    }
  }
  // The other checks need a start that satisfies the constraints.
  if (problem.residuals && !check_constraints(table, start)) return;
  if (const StartRefusal refusal = problem.refused_start(request.parameters, start.q); !refusal.message.empty()) {
    complain_of_start(table, table.has(FormulaKeys::constraints) ? FormulaKeys::constraints : "initial", refusal);
    return;
  }
  const bool unsolved = std::any_of(start.p.begin(), start.p.end(), [](double p) { return !std::isfinite(p); });
  if (!request.start.v.empty() && unsolved) {
    table.complain(
        "initial",
        "velocities do not determine the momenta, because the mass matrix is singular at this start; give p");
    return;
  }
  if (!problem.regular(request.parameters, start.q, start.p)) {
    complain_of_start(
        table, geometric ? "orbit" : "initial",
        {"a start where H or its derivatives are not finite; allowed a regular point of " + problem.info.formula});
    return;
  }
}

namespace {

/// Returns the typed constraint with the largest residual at a point, with its key; for other constraints the sum of
/// all residuals.
std::string largest_of(const Request& request, const Frame& at, double sum, const std::string& formula) {
  const FormulaTexts texts = formula_texts(request.variant);
  const std::string allowed = "; allowed at most " + shortest(most_residual_at_start) + ": ";
  if (texts.constraints.empty()) return "|g(q)| = " + shortest(sum) + allowed + formula;
  double most = -1;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < texts.constraints.size(); ++k) {
    FormulaTexts one = texts;
    one.constraints = {texts.constraints[k]};
    const double size =
        find_problem(request.problem, formula_choices(one))->residuals(request.parameters, at.q, at.p).position;
    if (size <= most) continue;
    most = size;
    worst = k;
    if (!std::isfinite(size)) break;
  }
  return "|g(q)| = " + shortest(most) + allowed + FormulaKeys::constraints + "[" + std::to_string(worst) +
         "] = " + texts.constraints[worst];
}

}  // namespace

/// Complains at the key that gives the start.
void ScenarioReader::complain_of_start(TomlTable& table, const std::string& usual, const StartRefusal& refusal) {
  scenario_.problem->particles ? complain_of_particles(table, usual, refusal)
                               : table.complain(usual, "found " + refusal.message);
}

/// Checks that the start lies on the constraints and its velocity is tangent to them.
bool ScenarioReader::check_constraints(TomlTable& table, const Frame& start) {
  const auto [position, velocity] = scenario_.problem->residuals(scenario_.request.parameters, start.q, start.p);
  if (!(position <= most_residual_at_start)) {
    table.complain("initial", "found a start that violates the constraints, " +
                                  largest_of(scenario_.request, start, position, scenario_.problem->info.formula));
    return false;
  }
  if (!(velocity <= most_residual_at_start)) {
    table.complain("initial", "found a velocity that leaves the constraints, |g'(q) M^-1 p| = " + shortest(velocity) +
                                  "; allowed at most " + shortest(most_residual_at_start) +
                                  ", a velocity along the constraints");
    return false;
  }
  return true;
}

}  // namespace hamflow
