// hamflow list, hamflow show: the catalogue as it is declared.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "experiments.hpp"
#include "figure_kinds.hpp"
#include "formula_keys.hpp"
#include "gas_options.hpp"
#include "guarded.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/gas.hpp"
#include "hamflow/run/large_steps.hpp"
#include "hamflow/run/state_names.hpp"
#include "hamflow/run/walls.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "meant.hpp"
#include "option_text.hpp"
#include "run_keys.hpp"

namespace hamflow::app {

namespace {

std::string flags(const MethodInfo& info) {
  std::string text = info.explicit_step ? "explicit" : "implicit";
  if (info.symplectic) text += ", symplectic";
  if (info.symmetric) text += ", symmetric";
  return text;
}

/// Words on lines of at most 110 characters, two deeper from the second line on.
std::string filled(const std::string& text, std::size_t indent = 2) {
  constexpr std::size_t widest = 110;
  std::string all;
  std::string row(indent, ' ');
  std::size_t words = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (words > 0 && row.size() + 1 + end - at > widest) {
      all += row + "\n";
      row.assign(indent + 2, ' ');
      words = 0;
    }
    row += (words > 0 ? " " : "") + text.substr(at, end - at);
    ++words;
    at = end + 1;
  }
  return all + row + "\n";
}

std::string option_row(const OptionInfo& option, const std::string& indent = "    ") {
  std::string text = fmt::format("{}{:<18} {:<12} {}\n", indent, option.name, default_text(option), explained(option));
  for (const OptionInfo& key : option.keys) text += option_row(key, indent + "  ");
  return text;
}

/// False where there is no table of that name.
bool show_table(const std::string& name) {
  for (const DeclaredTable& table : declared_tables()) {
    if (table.name != name) continue;
    std::cout << "keys of [" << name << "]:\n";
    for (const OptionInfo& key : table.keys) std::cout << option_row(key);
    return true;
  }
  return false;
}

/// What `show` was asked for where there is nothing of that name: the choices of problems come first, since "kepler"
/// is no slip of "euler".
std::string meant_by(const std::string& name, const std::vector<std::string>& names) {
  if (std::find(arithmetics().begin(), arithmetics().end(), name) != arithmetics().end()) {
    return "; did you mean " + run_path(run_keys().arithmetic) + " = \"" + name + "\"?";
  }
  if (name == "methods" || name == "problems" || name == "experiments")
    return "; did you mean hamflow list " + name + "?";
  std::string meant = suggested_problem(name);
  if (meant.empty()) meant = suggestion(name, names);
  return meant.empty() ? key_elsewhere(name) : meant;
}

/// The choices that find an entry in lists; those of a typed problem are its texts.
std::vector<std::pair<std::string, std::string>> variant_of(const ProblemEntry& entry) {
  std::vector<std::pair<std::string, std::string>> choices;
  if (entry.structure) return choices;
  const std::map<std::string, std::string> all(entry.info.variant.begin(), entry.info.variant.end());
  const auto kept = without_walls(all);
  std::copy_if(entry.info.variant.begin(), entry.info.variant.end(), std::back_inserter(choices),
               [&](const auto& choice) { return kept.contains(choice.first); });
  return choices;
}

std::string variant_text(const ProblemEntry& entry) {
  const auto is_number = [](const std::string& x) { return x.find_first_not_of("0123456789") == std::string::npos; };
  return joined(variant_of(entry), [&](const auto& choice) {
    const std::string quote = is_number(choice.second) ? "" : "\"";
    return choice.first + " = " + quote + choice.second + quote;
  });
}

std::string structure_text(const FormulaStructure& structure) {
  std::string text = structure.separable ? "separable, H = T(p) + V(q)" : "not separable";
  if (structure.quadratic_kinetic) text += ", T quadratic";
  return text + (structure.time ? ", dependent on t" : "");
}

/// Of what `coordinates` declares: a name, (z1), or dots.
std::string declared_momentum(const std::string& coordinate) {
  if (coordinate == "...") return coordinate;
  if (coordinate.front() != '(') return momentum_name(coordinate);
  return "(" + momentum_name(coordinate.substr(1));
}

/// A start of its own has as many as every other.
std::string degrees_of_freedom(const ProblemEntry& entry) {
  const std::size_t n = entry.dimension > 0 ? static_cast<std::size_t>(entry.dimension) : entry.info.default_q.size();
  if (!entry.constraint_form.empty()) return std::to_string(n) + ", less one for each constraint";
  return n > 0 ? std::to_string(n) : "as many as the start has";
}

void show_problem(const ProblemEntry& entry);

/// The keys of a problem with a Hamiltonian of the user, of which the catalogue has an example.
void show_formula(const ProblemEntry& example) {
  std::cout << fmt::format("{}\n  a Hamiltonian as it is typed, e.g. {}\n", example.info.name, example.info.formula);
  std::cout << "  keys of [problem]:\n";
  for (const OptionInfo& option : formula_options()) std::cout << option_row(option);
  for (const std::string& line : formula_language()) std::cout << filled(line);
  std::cout << "  initial = { q = [...], p = [...] } or { q, v }, or with energy and one component \"+\" or \"-\"\n"
               "  a scenario to begin with: hamflow new formula; what is found of one: hamflow show my.toml\n";
}

/// What a scenario describes: its problem, typed or not, and how it starts.
void show_scenario(const Scenario& scenario) {
  show_problem(*scenario.problem);
  for (const auto& [name, value] : scenario.request.parameters) {
    if (!value.empty()) std::cout << fmt::format("  here: {} = {}\n", name, value);
  }
  const bool gas = scenario.request.problem == GasKeys::problem;  // the walls are those of its box
  if (const auto walls = walls_among(scenario.request.variant); walls && !gas) {
    for (const Walls::Interval& wall : walls->intervals) {
      std::cout << fmt::format("  here: {} {} {} from {} to {}\n", wall_keys().wall_rule.name,
                               wall_rules()[static_cast<std::size_t>(walls->rule)], wall.coordinate,
                               wall.min.empty() ? "-infinity" : wall.min, wall.max.empty() ? "infinity" : wall.max);
    }
  }
  if (!scenario.request.method.name.empty()) {
    const MethodSpec taken = method_taken(scenario.request);
    if (taken.options != scenario.request.method.options) {
      std::cout << fmt::format(
          "  here: steps are solved by iteration = \"{}\": few second derivatives of H are not 0, "
          "and it costs less than newton\n",
          taken.options.at("iteration"));
    }
  }
  const auto list = [](const std::vector<double>& xs) { return joined(xs, shortest); };
  constexpr std::size_t most_shown = 100;
  std::cout << fmt::format(
      "  start: q = [{}], p = [{}], H = {}\n",
      scenario.start_q.size() > most_shown ? fmt::format("{} numbers", scenario.start_q.size())
                                           : list(scenario.start_q),
      scenario.start_p.size() > most_shown ? "as many" : list(scenario.start_p),
      shortest(scenario.problem->energy(scenario.request.parameters, scenario.start_q, scenario.start_p)));
}

/// How a run of the problem may begin.
void show_starts(const ProblemInfo& info) {
  if (!info.start_key.empty()) {
    std::cout << fmt::format("  {} = 1, ..., {}, each with its keys beside it:\n", info.start_key, info.starts.size());
  } else if (!info.starts.empty()) {
    std::cout << "  orbit = { kind = ..., direction = 1 or -1 } with\n";
  }
  for (const StartInfo& s : info.starts) {
    std::cout << fmt::format("    {:<18} {}  {}\n", s.kind.empty() ? "(without kind)" : s.kind, fmt::join(s.keys, ", "),
                             s.meaning);
  }
  if (info.two_bodies) {
    std::cout << "  bodies = [{ mass, position = [3], velocity = [3] }, { ... }]: two bodies in space, reduced\n";
  }
  std::cout << fmt::format("  initial = {{ q = [{0}], p = [...] }} or {{ q, v }}{1}\n",
                           fmt::join(info.coordinates, ", "),
                           info.default_q.empty() || info.default_p.empty()
                               ? ""
                               : fmt::format("; default q = [{}], p = [{}]", fmt::join(info.default_q, ", "),
                                             fmt::join(info.default_p, ", ")));
  std::cout << "    one component of p or v left to the energy: { q, p = [\"+\", ...], energy = E }, \"+\" the "
               "largest, \"-\" "
               "the smallest root of H = E\n";
}

/// What may stand between coordinates and walls.
void show_walls(const ProblemEntry& entry) {
  const ProblemInfo& info = entry.info;
  const WallKeys& keys = wall_keys();
  const bool fixed = !info.walls.empty();
  if (!fixed && !entry.constraint_form.empty()) return;  // they exclude each other
  for (const FixedWall& wall : info.walls) {
    std::cout << fmt::format("  walls: {} from {} to {}\n", info.coordinates.at(wall.coordinate), wall.min, wall.max);
  }
  if (!fixed) {
    std::cout << fmt::format("  {} = [{{ {} = \"{}\", {}, {} }}]: walls, with\n", keys.walls.name, keys.coordinate.name,
                             info.coordinates.front(), keys.min.name, keys.max.name);
  }
  for (const OptionInfo* key : {&keys.wall_rule, &keys.strength, &keys.exponent}) std::cout << option_row(*key);
  for (const auto& [name, text] : info.observables) std::cout << fmt::format("  observable: {} = {}\n", name, text);
}

/// Those of a typed problem; others have them in their formulas.
void show_constraints(const ProblemEntry& entry) {
  const FormulaTexts texts = formula_texts({entry.info.variant.begin(), entry.info.variant.end()});
  for (const std::string& text : texts.constraints) std::cout << fmt::format("  constraint: {} = 0\n", text);
  if (!texts.constraints.empty()) {
    std::cout << fmt::format("  {}: {}\n", constraint_form_option().name, texts.constraint_form);
  }
}

void show_problem(const ProblemEntry& entry) {
  const ProblemInfo& info = entry.info;
  std::cout << fmt::format("{}{}\n  {}\n  degrees of freedom: {}; source: {}\n", info.name,
                           variant_of(entry).empty() ? "" : " with " + variant_text(entry), info.formula,
                           degrees_of_freedom(entry), info.reference);
  if (entry.structure) std::cout << "  found: " << structure_text(*entry.structure) << "\n";
  if (!info.parameters.empty() || !info.frame.name.empty()) std::cout << "  keys of [problem]:\n";
  const bool gas = info.name == GasKeys::problem;
  for (const OptionInfo& key : gas ? all_gas_options() : info.parameters) std::cout << option_row(key);
  if (!info.frame.name.empty()) std::cout << option_row(info.frame);
  if (!info.velocities.name.empty()) std::cout << option_row(info.velocities);
  show_starts(info);
  show_walls(entry);
  std::cout << fmt::format("  momenta: {}\n",
                           entry.momenta.empty() ? joined(info.coordinates, declared_momentum) : joined(entry.momenta));
  const bool typed = entry.structure && info.name == FormulaKeys::problem;
  if (typed) show_constraints(entry);
  for (const InvariantInfo& i : info.invariants) {
    std::cout << fmt::format("  {}: {} = {}\n", typed ? "watched" : "conserved", i.name, i.meaning);
  }
}

void show_typed_central_force() {
  std::cout << "central-force with potential = \"formula\", coordinates = \"cartesian\" or \"polar\": V as it is typed "
               "(its language: hamflow show formula)\n";
  for (const OptionInfo& option : central_formula_options()) std::cout << option_row(option);
  // It starts like those of which no closed orbit is known.
  const auto alike = std::find_if(problems().begin(), problems().end(), [](const ProblemEntry& entry) {
    return entry.info.name == CentralKeys::problem && entry.info.starts.size() == 1 &&
           entry.info.starts[0].kind.empty();
  });
  if (alike != problems().end()) show_starts(alike->info);
}

void show_method(const MethodSpec& spec) {
  const MethodInfo info = describe(spec);
  std::cout << fmt::format("{}\n  {}\n  order {}, {}\n  source: {}\n", info.name, info.summary, info.order, flags(info),
                           info.reference);
  if (info.forces_per_step > 0) std::cout << fmt::format("  force evaluations per step: {}\n", info.forces_per_step);
  const MethodEntry& entry = find_method(spec.name);
  std::cout << "  needs " << entry.family->needs(entry.index) << "\n";
  const MethodAdvice said = advice(spec);
  if (!said.purpose.empty()) std::cout << filled("for " + said.purpose);
  if (!said.take.empty()) std::cout << filled("take it where " + said.take);
  if (!said.avoid.empty()) std::cout << filled("not where " + said.avoid);
  const std::vector<OptionInfo>& options = entry.family->options;
  if (!options.empty()) std::cout << "  keys of [method]:\n";
  for (const OptionInfo& option : options) std::cout << option_row(option);
  std::cout << "  measured properties: hamflow verify " << (info.name == spec.name ? info.name : "'" + info.name + "'")
            << "\n";
}

/// The first line of what a list says of a method.
std::string method_row(const MethodEntry& entry) {
  const MethodInfo info = describe(MethodSpec{.name = entry.name});
  return fmt::format("{:<16} order {:<3} {:<34} {}\n", entry.name, info.order, flags(info), info.summary);
}

/// The few with which to begin, and for what; then the names of all others, family by family.
void print_methods() {
  const std::vector<std::string> first = first_methods();
  std::cout << "Begin with one of these (hamflow show NAME says more):\n\n";
  for (const std::string& name : first) {
    const MethodInfo info = describe(MethodSpec{.name = name});
    std::cout << fmt::format("{:<10} order {:<3} {}\n", name, info.order, advice(MethodSpec{.name = name}).purpose);
  }
  std::cout << "\nAll others (each with a line: hamflow list methods --all):\n";
  for (const MethodFamily& family : method_families()) {
    std::vector<std::string> others;
    for (const std::string& name : family.methods) {
      if (std::find(first.begin(), first.end(), name) == first.end()) others.push_back(name);
    }
    if (!others.empty()) std::cout << '\n' << filled(family.name + ": " + family.meaning) << filled(joined(others), 4);
  }
}

void print_all_methods() {
  for (const MethodFamily& family : method_families()) {
    std::cout << (&family == method_families().data() ? "" : "\n") << family.name << ": " << family.meaning << '\n';
    for (const MethodEntry& entry : methods()) {
      if (entry.family == &family) std::cout << method_row(entry);
    }
  }
}

nlohmann::ordered_json methods_json() {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const MethodEntry& entry : methods()) {
    const MethodSpec spec{.name = entry.name};
    const MethodInfo info = describe(spec);
    const MethodAdvice said = advice(spec);
    all.push_back({{"name", entry.name},
                   {"order", info.order},
                   {"explicit", info.explicit_step},
                   {"symplectic", info.symplectic},
                   {"symmetric", info.symmetric},
                   {"summary", info.summary},
                   {"family", entry.family->name},
                   {"begin_with", !said.purpose.empty()},
                   {"purpose", said.purpose},
                   {"take", said.take},
                   {"avoid", said.avoid}});
  }
  return all;
}

nlohmann::ordered_json problems_json() {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ProblemEntry& entry : problems()) {
    all.push_back({{"name", entry.info.name},
                   {"variant", variant_of(entry)},
                   {"formula", entry.info.formula},
                   {"degrees_of_freedom", entry.dimension}});
  }
  return all;
}

void print_problems() {
  for (const ProblemEntry& entry : problems()) {
    std::cout << fmt::format("{:<26} {}{}\n", entry.info.name, entry.info.formula,
                             variant_of(entry).empty() ? "" : "  (" + variant_text(entry) + ")");
  }
  std::cout << fmt::format("{:<26} H = |p|^2/(2 mu) + V(r), V(r) as it is typed  (potential = \"formula\")\n",
                           CentralKeys::problem);
}

}  // namespace

int list_command(const std::string& what, bool all, bool json) {
  return guarded(json, [&] {
    if (what == "experiments")
      become_reproduce(json ? std::vector<std::string>{"--list", "--json"} : std::vector<std::string>{"--list"});
    const bool of_methods = what == "methods";
    if (json) {
      std::cout << (of_methods ? methods_json() : problems_json()).dump(2) << '\n';
    } else if (!of_methods) {
      print_problems();
    } else if (all) {
      print_all_methods();
    } else {
      print_methods();
    }
    return exit_done;
  });
}

int show_command(const std::string& name, const std::string& folder) {
  return guarded(false, [&] {
    if (!folder.empty()) {
      const std::vector<std::string> ids = experiment_ids();
      if (ids.empty() || std::find(ids.begin(), ids.end(), name) != ids.end())
        become_reproduce({"--show", name, "--out", folder});
      throw Rejection("--out", "found --out with " + name + "; allowed with an experiment (hamflow list experiments)");
    }
    if (name.ends_with(".toml")) {
      show_scenario(accepted(read_scenario(name, {})));
      return exit_done;
    }
    bool found = false;
    std::vector<std::string> names;
    for (const ProblemEntry& entry : problems()) {
      names.push_back(entry.info.name);
      if (entry.info.name != name) continue;
      entry.structure ? show_formula(entry) : show_problem(entry);
      found = true;
    }
    if (name == CentralKeys::problem) show_typed_central_force();
    if (found || show_table(name)) return exit_done;
    for (const FigureKindInfo& kind : figure_kinds()) {
      names.push_back(kind.name);
      if (kind.name != name) continue;
      std::cout << fmt::format("{}\n  a figure: {}\n  hamflow plot RUN --kind {}; output.figures of a scenario\n", name,
                               kind.meaning, name);
      return exit_done;
    }
    for (const MethodEntry& entry : methods()) names.push_back(entry.name);
    for (const DeclaredTable& table : declared_tables()) names.push_back(table.name);
    const std::string method = name.substr(0, name.find('('));
    if (std::find(names.begin(), names.end(), method) == names.end()) {
      const std::vector<std::string> ids = experiment_ids();
      if (std::find(ids.begin(), ids.end(), name) != ids.end()) become_reproduce({"--show", name});
      names.insert(names.end(), ids.begin(), ids.end());
      throw Error("there is no problem, method, figure or experiment '" + name + "'" + meant_by(method, names) +
                  " (hamflow list problems, hamflow list methods, hamflow list experiments; keys: hamflow show run, "
                  "hamflow show output)" +
                  (ids.empty() ? "; experiments are known once ./dev theses has built hamflow-reproduce" : ""));
    }
    show_method(parse_method(name));
    return exit_done;
  });
}

}  // namespace hamflow::app
