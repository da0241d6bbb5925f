#include "scenario.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "toml_table.hpp"

namespace hamflow {

namespace {

constexpr std::int64_t most_steps = std::int64_t{1} << 53;  // t = n h needs n exact in double

/// Reads the checked parts of one scenario; every find* leaves its complaints behind and goes on.
class ScenarioReader {
 public:
  ScenarioReader(const toml::table& root, const std::string& file, std::vector<Complaint>& complaints)
      : root_(&root, "", file, complaints), complaints_(complaints) {
    scenario_.file = file;
  }

  Scenario read() {
    TomlTable problem = root_.table("problem");
    TomlTable method = root_.table("method");
    TomlTable run = root_.table("run");
    TomlTable output = root_.table("output");
    read_problem(problem);
    read_method(method);
    read_run(run);
    read_output(output);
    root_.finish();
    return scenario_;
  }

 private:
  void read_problem(TomlTable& table);
  void read_variant(TomlTable& table, const std::string& name);
  void read_orbit(TomlTable& table);
  void read_initial(TomlTable& table);
  void check_start(TomlTable& table);
  void read_method(TomlTable& table);
  void read_cg(TomlTable& table);
  void read_run(TomlTable& table);
  void read_length(TomlTable& table);
  void read_lattice(TomlTable& table);
  void read_output(TomlTable& table);

  TomlTable root_;
  std::vector<Complaint>& complaints_;
  Scenario scenario_;
};

std::vector<std::string> problem_names() {
  std::vector<std::string> names;
  for (const ProblemEntry& entry : problems()) {
    if (std::find(names.begin(), names.end(), entry.info.name) == names.end()) names.push_back(entry.info.name);
  }
  return names;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods()) names.push_back(entry.name);
  return names;
}

void ScenarioReader::read_problem(TomlTable& table) {
  if (!table.has("name")) {
    table.missing("name", joined(problem_names()));
    return;
  }
  const auto name = table.choice("name", problem_names());
  if (!name) return;
  scenario_.request.problem = *name;
  read_variant(table, *name);
  if (scenario_.problem == nullptr) return;
  const std::size_t before = complaints_.size();
  const ProblemInfo& info = scenario_.problem->info;
  for (const ParameterInfo& parameter : info.parameters) {
    const auto value = table.number(parameter.name);
    if (!value) continue;
    if (parameter.range == Range::positive && !(value->value > 0)) {
      table.complain(parameter.name,
                     table.found(parameter.name) + "; allowed a positive number (" + parameter.meaning + ")");
    } else if (parameter.range == Range::not_negative && value->value < 0) {
      table.complain(parameter.name,
                     table.found(parameter.name) + "; allowed a number not below 0 (" + parameter.meaning + ")");
    }
    scenario_.request.parameters[parameter.name] = value->text;
  }
  scenario_.request.parameters = complete(info, scenario_.request.parameters);
  if (!info.starts.empty()) read_orbit(table);
  read_initial(table);
  table.finish();
  if (complaints_.size() == before) check_start(table);
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

void ScenarioReader::read_method(TomlTable& table) {
  if (!table.has("name")) {
    table.missing("name", joined(method_names()));
    return;
  }
  const auto name = table.choice("name", method_names());
  if (!name) return;
  scenario_.request.method.name = *name;
  if (*name == "cg") read_cg(table);
  table.finish();
}

void ScenarioReader::read_cg(TomlTable& table) {
  CgOptions& cg = scenario_.request.method.cg;
  if (const auto degree = table.whole("degree", 1, 1)) cg.degree = static_cast<int>(*degree);
  if (table.has("quadrature") && table.found("quadrature") == "found \"auto\" (a string)") {
    table.know("quadrature");
  } else if (table.has("quadrature")) {
    if (const auto points = table.whole("quadrature", cg.degree, 64)) {
      cg.quadrature = static_cast<int>(*points);
    } else {
      complaints_.back().message += ", or \"auto\"";
    }
  } else {
    table.know("quadrature");
  }
  if (const auto tolerance = table.number("tolerance")) {
    if (tolerance->value > 0) {
      cg.tolerance = tolerance->value;
    } else {
      table.complain("tolerance", table.found("tolerance") + "; allowed a positive number");
    }
  }
  if (const auto criterion = table.choice("criterion", {"stagnation", "seed"}); criterion == "seed") {
    cg.seed_criterion = true;
    if (!cg.tolerance) cg.tolerance = 1e-13;  // the listings' own
  }
  if (const auto most = table.whole("max_iterations", 1, 1000)) cg.max_iterations = static_cast<int>(*most);
  (void)table.choice("iteration", {"newton"});
  if (const auto remedy = table.choice("on_divergence", {"error", "halve"})) cg.halve = *remedy == "halve";
}

void ScenarioReader::read_run(TomlTable& table) {
  if (!table.has("dt")) {
    table.know("dt");
    table.missing("dt", "a number other than 0");
  } else if (const auto dt = table.number("dt")) {
    if (dt->value == 0) table.complain("dt", table.found("dt") + "; allowed a number other than 0");
    scenario_.dt = dt->value;
    scenario_.request.dt = dt->text;
  }
  read_length(table);
  if (const auto every = table.whole("record_every", 1, most_steps)) {
    scenario_.record_every = *every;
  } else {
    scenario_.record_every = default_record_every(scenario_.steps);
  }
  if (const auto arithmetic = table.choice("arithmetic", arithmetics())) {
    scenario_.request.arithmetic = *arithmetic;
    const std::string why_not =
        scenario_.request.method.name.empty() ? "" : refusal(scenario_.request.method, *arithmetic);
    if (!why_not.empty()) table.complain("arithmetic", table.found("arithmetic") + "; " + why_not);
  }
  (void)table.choice("kernel", {"exact"});
  read_lattice(table);
  table.finish();
}

void ScenarioReader::read_length(TomlTable& table) {
  const bool by_steps = table.has("steps");
  const bool by_time = table.has("t_end");
  const auto steps = table.whole("steps", 0, most_steps);
  const auto t_end = table.number("t_end");
  if (by_steps && by_time) {
    table.complain("t_end", "found steps and t_end together; allowed exactly one of them");
  } else if (!by_steps && !by_time) {
    table.missing("steps", "exactly one of steps, t_end");
  } else if (steps) {
    scenario_.steps = *steps;
  } else if (t_end && scenario_.dt != 0) {
    const double ratio = t_end->value / scenario_.dt;
    const double whole = std::round(ratio);
    if (ratio < 0) {
      table.complain("t_end",
                     table.found("t_end") + " with dt = " + shortest(scenario_.dt) + "; allowed the sign of dt");
    } else if (whole > static_cast<double>(most_steps)) {
      table.complain("t_end", table.found("t_end") + "; allowed at most 2^53 steps of dt");
    } else if (std::abs(ratio - whole) > 1e-9 * std::max(1.0, whole)) {
      const double fitting = std::max(whole, 1.0);
      table.complain(
          "t_end", table.found("t_end") + ", which is " + shortest(ratio) + " steps of dt = " + shortest(scenario_.dt) +
                       "; allowed a whole number of steps, nearest dt = " + shortest(t_end->value / fitting) +
                       " or t_end = " + shortest(whole * scenario_.dt));
    } else {
      scenario_.steps = static_cast<std::int64_t>(whole);
    }
  }
}

void ScenarioReader::read_lattice(TomlTable& table) {
  const bool on_lattice = scenario_.request.arithmetic == "lattice";
  if (table.has("lattice")) {
    TomlTable lattice = table.table("lattice");
    const auto unit = [&](const char* key, double& out) {
      const auto value = lattice.number(key);
      if (!value) return;
      int exponent = 0;
      if (std::frexp(value->value, &exponent) != 0.5 || std::abs(exponent) > 500) {
        lattice.complain(key, lattice.found(key) + "; allowed a power of two such as \"2^-52\"");
      }
      out = value->value;
    };
    unit("position", scenario_.request.position_unit);
    unit("momentum", scenario_.request.momentum_unit);
    lattice.finish();
    if (!on_lattice) {
      table.complain("lattice", "found units for arithmetic \"" + scenario_.request.arithmetic +
                                    "\"; allowed with arithmetic = \"lattice\"");
    }
  } else {
    table.know("lattice");
  }
  if (!on_lattice) return;
  const auto reach = [](const std::vector<double>& values) {
    double most = 0;
    for (const double x : values) most = std::max(most, std::abs(x));
    return most;
  };
  const auto check = [&](const char* what, double largest, double unit) {
    if (largest < unit * 0x1p62) return;
    table.complain("lattice", std::string("found ") + what + " up to " + shortest(largest) + " at the start, with a unit of " +
                                  shortest(unit) + "; allowed below 2^62 units: choose a larger power of two");
  };
  check("positions", reach(scenario_.start_q), scenario_.request.position_unit);
  check("momenta", reach(scenario_.start_p), scenario_.request.momentum_unit);
}

void ScenarioReader::read_output(TomlTable& table) {
  if (const auto folder = table.string("folder")) {
    if (folder->empty()) table.complain("folder", "found an empty name; allowed a folder");
    scenario_.folder = *folder;
  }
  if (const auto formats = table.choices("formats", {"h5", "csv"})) scenario_.formats = *formats;
  if (const auto figures = table.choices("figures", {"orbit", "energy", "energy-error", "phase"}))
    scenario_.figures = *figures;
  const auto wants = [&](const std::vector<std::string>& list, const char* word) {
    return std::find(list.begin(), list.end(), word) != list.end();
  };
  if (!scenario_.figures.empty() && !wants(scenario_.formats, "h5")) {
    table.complain("figures",
                   "found figures without the format h5, from which they are drawn; allowed formats = [\"h5\", ...]");
  }
  if (wants(scenario_.figures, "orbit") && scenario_.problem != nullptr && scenario_.problem->dimension != 2) {
    table.complain("figures", "found \"orbit\" for a problem with " + std::to_string(scenario_.problem->dimension) +
                                  " degree of freedom; allowed phase, energy, energy-error");
  }
  table.finish();
}

/// Puts a --set PATH=VALUE into the document.
void apply_set(toml::table& root, const std::string& set, const std::string& file, std::vector<Complaint>& complaints) {
  const auto equals = set.find('=');
  const std::string path = set.substr(0, equals);
  if (equals == std::string::npos || path.empty()) {
    complaints.push_back({file, 0, 0, set, "found no PATH=VALUE; allowed e.g. --set run.dt=0.05"});
    return;
  }
  const std::string text = set.substr(equals + 1);
  toml::table value;
  try {
    value = toml::parse("value = " + text);
  } catch (const toml::parse_error&) {
    value.clear();
  }
  if (value.size() != 1) {  // not a TOML value: a string
    value.clear();
    value.insert_or_assign("value", text);
  }
  toml::table* table = &root;
  std::string rest = path;
  for (auto dot = rest.find('.'); dot != std::string::npos; dot = rest.find('.')) {
    const std::string head = rest.substr(0, dot);
    if (!table->contains(head)) table->insert(head, toml::table{});
    table = table->get(head)->as_table();
    if (table == nullptr) {
      complaints.push_back({file, 0, 0, path, "found " + head + " to be no table; allowed a path through tables"});
      return;
    }
    rest = rest.substr(dot + 1);
  }
  table->insert_or_assign(rest, *value.get("value"));
}

}  // namespace

std::int64_t sample_count(std::int64_t steps, std::int64_t record_every) {
  return steps / record_every + 1 + (steps % record_every != 0 ? 1 : 0);
}

std::int64_t default_record_every(std::int64_t steps) {
  constexpr std::int64_t most_samples = 10000;
  std::int64_t every = std::max<std::int64_t>(1, steps / most_samples);
  while (sample_count(steps, every) > most_samples) ++every;
  return every;
}

Reading read_scenario_text(const std::string& text, const std::string& name, const std::vector<std::string>& sets) {
  Reading reading;
  toml::table root;
  try {
    root = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    reading.complaints.push_back({name, static_cast<int>(error.source().begin.line),
                                  static_cast<int>(error.source().begin.column), "syntax",
                                  "found no valid TOML: " + std::string(error.description())});
    return reading;
  }
  std::string full_text = text;
  for (const std::string& set : sets) {
    apply_set(root, set, name, reading.complaints);
    full_text += "# --set " + set + "\n";
  }
  Scenario scenario = ScenarioReader(root, name, reading.complaints).read();
  scenario.text = full_text;
  // In the order of the file, so that a reader can walk through it.
  std::stable_sort(reading.complaints.begin(), reading.complaints.end(),
                   [](const Complaint& a, const Complaint& b) { return a.line < b.line; });
  if (reading.complaints.empty()) reading.scenario = std::move(scenario);
  return reading;
}

Reading read_scenario(const std::filesystem::path& file, const std::vector<std::string>& sets) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file)) throw FileError("cannot read the scenario " + file.string());
  std::ostringstream text;
  text << in.rdbuf();
  return read_scenario_text(text.str(), file.string(), sets);
}

}  // namespace hamflow
