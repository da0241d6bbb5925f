// Reads the walls in [problem] and refuses settings that do not work with them.
#include <algorithm>
#include <cmath>

#include "gas/container.hpp"
#include "hamflow/detail/run/fitting_methods.hpp"
#include "hamflow/run/socket.hpp"
#include "hamflow/run/state_names.hpp"
#include "scenario_reader.hpp"
#include "wall_checks.hpp"

namespace hamflow {

namespace {

/// Returns the names of coordinates as `show` lists them; for bodies also the numbered names q1, q2, ...
std::vector<std::vector<std::string>> coordinate_names(const ProblemEntry& problem, const Texts& parameters,
                                                       std::size_t size) {
  std::vector<std::vector<std::string>> names{state_names(problem, parameters, size).q};
  if (problem.dimension == 0) names.push_back(numbered_names(size).q);
  return names;
}

std::optional<Walls::Interval> read_interval(TomlTable& table, const std::vector<std::vector<std::string>>& names,
                                             bool both) {
  const WallKeys& keys = wall_keys();
  OptionInfo coordinate = keys.coordinate;
  for (const auto& list : names) {
    for (const std::string& name : list) {
      if (std::find(coordinate.words.begin(), coordinate.words.end(), name) == coordinate.words.end()) {
        coordinate.words.push_back(name);
      }
    }
  }
  const auto name = table.text(coordinate);
  const auto min = table.text(keys.min);
  const auto max = table.text(keys.max);
  const bool has_min = table.has(keys.min.name);
  const bool has_max = table.has(keys.max.name);
  table.finish();
  if ((has_min && !min) || (has_max && !max) || !name) return std::nullopt;
  if (!min && !max) {
    table.missing(keys.min.name, "a number, or " + keys.max.name + ", or both");
    return std::nullopt;
  }
  if (both && (!min || !max)) {
    table.missing((min ? keys.max : keys.min).name, "a number, because soft walls need both ends of the interval");
    return std::nullopt;
  }
  if (min && max && !(number_value(*min) < number_value(*max))) {
    table.complain(keys.max.name, table.found(keys.max.name) + "; allowed more than " + keys.min.name + " = " + *min);
    return std::nullopt;
  }
  Walls::Interval interval{*name, 0, min.value_or(""), max.value_or("")};
  for (const auto& list : names) {
    const auto place = std::find(list.begin(), list.end(), *name);
    if (place != list.end()) interval.index = static_cast<std::size_t>(place - list.begin());
  }
  for (std::string* text : {&interval.min, &interval.max}) std::erase(*text, ' ');
  return interval;
}

}  // namespace

void ScenarioReader::read_walls(TomlTable& table) {
  if (scenario_.problem->container == ContainerNames::box) return read_box(table);
  const WallKeys& keys = wall_keys();
  const ProblemInfo& info = scenario_.problem->info;
  const bool fixed = !info.walls.empty();
  table.know_all({keys.walls.name, keys.wall_rule.name, keys.strength.name, keys.exponent.name});
  const std::size_t before = complaints_.size();
  if (info.name == SocketKeys::problem && table.has_any(keys.walls.name)) {
    table.complain(keys.walls.name,
                   "found walls; allowed without walls for " + info.name + ", whose client computes all forces");
    return;
  }
  if (!fixed && !scenario_.problem->constraint_form.empty() && table.has_any(keys.walls.name)) {
    table.complain(keys.walls.name,
                   "found walls together with constraints, which are not supported; allowed in coordinates without "
                   "constraints");
    return;
  }
  if (fixed && table.has(keys.walls.name)) {
    table.complain(keys.walls.name,
                   "found walls, but the walls of " + info.name + " are fixed; allowed only " + keys.wall_rule.name);
  }
  if (!fixed && !table.has_any(keys.walls.name)) {
    const bool taken_away = table.has(keys.walls.name);  // an empty list removes the walls; their keys are not used
    for (const OptionInfo* key : {&keys.wall_rule, &keys.strength, &keys.exponent}) {
      // The exponent of a container is another key.
      if (taken_away) {
        (void)table.text(*key);
      } else if (table.has(key->name)) {
        table.complain(key->name, table.found(key->name) + "; allowed with " + keys.walls.name);
      }
    }
    return;
  }
  Walls walls;
  const auto rule = table.text(keys.wall_rule);
  if (rule) {
    walls.rule =
        static_cast<WallRule>(std::find(wall_rules().begin(), wall_rules().end(), *rule) - wall_rules().begin());
  }
  for (const auto& [key, to] :
       {std::pair{&keys.strength, &walls.strength}, std::pair{&keys.exponent, &walls.exponent}}) {
    if (walls.hard() && table.has(key->name) && (rule || !table.has(keys.wall_rule.name))) {
      table.complain(key->name, table.found(key->name) + "; allowed with " + keys.wall_rule.name + " = \"soft\"");
    } else if (const auto text = table.text(*key)) {
      *to = *text;
      std::erase(*to, ' ');
    }
  }
  const Texts& parameters = scenario_.request.parameters;
  const std::size_t size =
      scenario_.problem->dimension > 0 ? scenario_.problem->dimension : scenario_.request.start.q.size();
  if (complaints_.size() != before || size == 0) return;
  if (!scenario_.problem->refused_size(parameters, size).empty()) return;  // another check reports this
  const auto names = coordinate_names(*scenario_.problem, parameters, size);
  for (const FixedWall& wall : info.walls) {
    walls.intervals.push_back({names.front().at(wall.coordinate), wall.coordinate, wall.min, wall.max});
  }
  if (!fixed) {
    auto tables = table.tables(keys.walls.name, 0);
    if (!tables) return;
    for (TomlTable& entry : *tables) {
      const auto interval = read_interval(entry, names, !walls.hard());
      if (!interval) continue;
      const bool again = std::any_of(walls.intervals.begin(), walls.intervals.end(),
                                     [&](const auto& other) { return other.index == interval->index; });
      if (again) {
        entry.complain(keys.coordinate.name, entry.found(keys.coordinate.name) +
                                                 " a second time; allowed one interval "
                                                 "of each coordinate");
      }
      walls.intervals.push_back(*interval);
    }
  }
  if (scenario_.bodies) {
    table.complain(keys.walls.name,
                   "found walls together with bodies; allowed with initial or orbit, because bodies are reduced to "
                   "other coordinates");
  }
  if (complaints_.size() != before) return;
  scenario_.request.walls = walls;
  scenario_.problem = find_problem(scenario_.request);
}

namespace {
/// Returns those of `rules` that this problem allows, in quotes, separated by ", ". Walls of a box are hard, soft walls
/// need two ends, and on the lattice steps cannot be cut at a bounce.
std::string rules_taken(const Request& request, const ProblemEntry& problem, const Walls& walls,
                        const std::vector<WallRule>& rules) {
  const bool box = problem.container == ContainerNames::box;
  const bool ends = std::all_of(walls.intervals.begin(), walls.intervals.end(),
                                [](const auto& wall) { return !wall.min.empty() && !wall.max.empty(); });
  std::string words;
  for (const WallRule rule : rules) {
    if (rule == WallRule::soft && (box || !ends)) continue;
    if (rule == WallRule::event && request.arithmetic == "lattice") continue;
    words += (words.empty() ? "\"" : ", \"") + wall_rules()[static_cast<std::size_t>(rule)] + "\"";
  }
  return words;
}
}  // namespace

std::string refused_by_walls(const Request& request, const ProblemEntry& problem, const std::vector<double>& start_q) {
  const auto& walls = request.walls;
  if (!walls) return {};
  const MethodInfo info = describe(request.method);
  if (walls->hard() && info.varies_steps) {
    const std::string soft = rules_taken(request, problem, *walls, {WallRule::soft});
    return "with steps of varying size, which cannot be cut at a wall; allowed " + soft +
           (soft.empty() ? "" : ", or ") + "step_control = \"fixed\"";
  }
  if (info.carries_copy && walls->hard()) {
    return "with " + info.name + ", whose second copy of the state meets walls at other times; allowed " +
           or_fitting_method(rules_taken(request, problem, *walls, {WallRule::soft}), "another method",
                             {"stv4", "cg", "rk4"}, &problem, request.arithmetic);
  }
  if (walls->rule == WallRule::event && request.arithmetic == "lattice") {
    return "on the lattice, where a part of a step cannot be undone exactly; allowed \"mirror\", \"reject\"";
  }
  if (walls->rule != WallRule::mirror) return {};
  if (!problem.constraint_form.empty())
    return "with constraints, where drifts are not free; allowed \"event\", \"reject\"";
  const bool drifts = find_method(request.method.name).family->not_on_lattice.empty();
  if (!drifts) {
    return "with " + info.name + ", which has no drifts that could be reflected; allowed " +
           or_fitting_method(rules_taken(request, problem, *walls, {WallRule::event, WallRule::reject}),
                             "a splitting method", {"stv4"}, &problem, request.arithmetic);
  }
  const bool quadratic = problem.accepts({.name = "calvo-sanz-serna4"});  // this method needs constant masses
  for (const Walls::Interval& wall : walls->intervals) {
    if (problem.particles) break;  // each particle has its own mass
    std::vector<double> p(start_q.size(), 0.0);
    p[wall.index] = 1;
    const std::vector<double> v = problem.gradient(request.parameters, start_q, p).by_p;
    for (std::size_t k = 0; k < v.size(); ++k) {
      if (quadratic && (k == wall.index || v[k] == 0)) continue;
      return "where the velocity of " + wall.coordinate +
             (quadratic ? " depends on other momenta too"
                        : " is not a "
                          "constant times its momentum") +
             ", so a reflected drift would not solve the equations of H; allowed \"event\", \"reject\"";
    }
  }
  return {};
}

std::string rule_of_walls(const Request& request) {
  const auto& walls = request.walls;
  return walls ? wall_rules()[static_cast<std::size_t>(walls->rule)] : std::string();
}

/// Complains if the method is refused only because of the potential of soft walls. Returns true if it complained.
bool ScenarioReader::complain_of_soft_walls() {
  const Request& request = scenario_.request;
  const auto& walls = request.walls;
  if (!walls || walls->hard()) return false;
  const auto inside_entry = find_problem(request.problem, request.variant);
  const ProblemEntry& inside = *inside_entry;
  if (!refusal(request.method, inside).empty()) return false;
  std::vector<WallRule> hard{WallRule::event, WallRule::reject};
  if (find_method(request.method.name).family->not_on_lattice.empty()) hard.push_back(WallRule::mirror);
  root_.table("problem").complain(
      wall_keys().wall_rule.name,
      "found \"" + rule_of_walls(request) + "\" with " + request.method.name +
          ", which does not allow the potential of a wall; allowed " +
          or_fitting_method(rules_taken(request, *scenario_.problem, *walls, hard), "another method",
                            {"cg", "stv4", "rk4"}, scenario_.problem.get(), request.arithmetic));
  return true;
}

/// Makes the checks that need the method and the arithmetic.
void ScenarioReader::check_walls() {
  const Request& request = scenario_.request;
  const auto& walls = request.walls;
  if (!walls || scenario_.problem == nullptr || scenario_.start_q.empty() || !has_method()) return;
  const WallKeys& keys = wall_keys();
  TomlTable table = root_.table("problem");
  const auto refuse = [&](const std::string& why) {
    table.complain(
        table.has(keys.wall_rule.name) || !table.has(keys.walls.name) ? keys.wall_rule.name : keys.walls.name,
        "found \"" + rule_of_walls(request) + (table.has(keys.wall_rule.name) ? "\" " : "\", the default here, ") +
            why);
  };
  const std::string why_not = refused_by_walls(request, *scenario_.problem, scenario_.start_q);
  if (!why_not.empty()) return refuse(why_not);
  if (walls->rule != WallRule::mirror || request.arithmetic != "lattice") return;
  const double unit = request.position_unit;
  double furthest = 0;
  for (const Walls::Interval& wall : walls->intervals) {
    for (const std::string& text : {wall.min, wall.max})
      furthest = std::max(furthest, text.empty() ? 0 : std::abs(number_value(text)));
  }
  double most = 0;
  std::vector<std::string> notes;
  for (const Walls::Interval& wall : walls->intervals) {
    for (const std::string& text : {wall.min, wall.max}) {
      if (text.empty()) continue;
      const double at = number_value(text);
      if (std::abs(at) > 0x1p51 * unit) {
        int power = 0;  // exponent of the finest spacing that suffices for every wall
        if (std::frexp(furthest, &power) == 0.5) --power;
        refuse("with a wall at " + text + " and the grid spacing " + shortest(unit) +
               "; allowed walls within 2^51 spacings, so that positions behind them are exact in double, e.g. "
               "run.lattice = { position = \"2^" +
               std::to_string(power - 51) + "\" }");
        return;
      }
      const double moved = on_half_lattice(at, unit) - at;
      if (moved == 0) continue;
      most = std::max(most, std::abs(moved));
      notes.push_back("the wall of " + wall.coordinate + " at " + text + " is moved by " + shortest(moved) +
                      " to a multiple of half a grid spacing");
    }
  }
  if (notes.empty()) return;
  if (scenario_.problem->particles) {  // one note, because all particles have the same walls
    notes = {"the walls of the box are moved by up to " + shortest(most) + " to multiples of half a grid spacing"};
  }
  scenario_.notes.insert(scenario_.notes.end(), notes.begin(), notes.end());
}

}  // namespace hamflow
