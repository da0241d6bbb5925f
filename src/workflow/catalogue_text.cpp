#include "hamflow/workflow/catalogue_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/large_steps.hpp"
#include "figure_kinds.hpp"
#include "gas/container.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/detail/run/formula_options.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/formula/tex.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/state_names.hpp"
#include "hamflow/run/walls.hpp"
#include "option_text.hpp"
#include "run_keys.hpp"
#include "suggested_names.hpp"

namespace hamflow {

namespace {

using Json = nlohmann::ordered_json;

std::string flags(const MethodInfo& info) {
  std::string text = info.explicit_step ? "explicit" : "implicit";
  if (info.symplectic) text += ", symplectic";
  if (info.symmetric) text += ", symmetric";
  return text;
}

/// Breaks a text into lines of at most 110 characters. Lines after the first are indented by two more.
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

/// Writes the keys of a table; returns false if no table has this name.
bool write_keys(std::ostream& out, const std::string& name) {
  for (const DeclaredTable& table : declared_tables()) {
    if (table.name != name) continue;
    out << "keys of [" << name << "]:\n";
    for (const OptionInfo& key : table.keys) out << option_row(key);
    return true;
  }
  return false;
}

/// Suggests a known name for an unknown one. Choices of problems are tried first: "kepler" is a potential, not a
/// misspelt "euler".
std::string suggested_name(const std::string& name, const std::vector<std::string>& names) {
  if (std::find(arithmetics().begin(), arithmetics().end(), name) != arithmetics().end()) {
    return "; did you mean " + run_path(run_keys().arithmetic) + " = \"" + name + "\"?";
  }
  if (name == "methods" || name == "problems" || name == "experiments")
    return "; did you mean " + command_name("list " + name) + "?";
  std::string meant = suggested_problem(name);
  if (meant.empty()) meant = suggestion(name, names);
  return meant.empty() ? key_elsewhere(name) : meant;
}

/// Returns the choices that lists print next to a problem. A typed problem has none, because its choices are its
/// formulas.
std::vector<std::pair<std::string, std::string>> variant_of(const ProblemEntry& entry) {
  if (entry.structure) return {};
  return {entry.info.variant.begin(), entry.info.variant.end()};
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

/// Returns the momentum of a declared coordinate, which is a name, a name in parentheses such as (z1), or dots.
std::string declared_momentum(const std::string& coordinate) {
  if (coordinate == "...") return coordinate;
  if (coordinate.front() != '(') return momentum_name(coordinate);
  return "(" + momentum_name(coordinate.substr(1));
}

/// Returns the number of degrees of freedom as text. If it is not fixed, it follows from the start.
std::string degrees_of_freedom(const ProblemEntry& entry) {
  const std::size_t n = entry.dimension > 0 ? static_cast<std::size_t>(entry.dimension) : entry.info.default_q.size();
  if (!entry.constraint_form.empty()) return std::to_string(n) + ", minus one for each constraint";
  return n > 0 ? std::to_string(n) : "given by the start";
}

void write_problem(std::ostream& out, const ProblemEntry& entry);

/// Writes the keys of a problem whose Hamiltonian is typed. `example` is the example in the catalogue.
void write_formula(std::ostream& out, const ProblemEntry& example) {
  out << fmt::format("{}\n  a Hamiltonian that you type, e.g. {}\n", example.info.name, example.info.formula);
  out << "  keys of [problem]:\n";
  for (const OptionInfo& option : keys_of(example.info)) out << option_row(option);
  for (const std::string& line : formula_language()) out << filled(line);
  out << "  initial = { q = [...], p = [...] } or { q, v }, or with energy and one component \"+\" or \"-\"\n"
         "  hamflow new formula prints a scenario to start from; hamflow show my.toml describes a scenario\n";
}

/// Describes a scenario: its problem, its settings and its start.
void write_scenario(std::ostream& out, const Scenario& scenario) {
  write_problem(out, *scenario.problem);
  for (const auto& [name, value] : scenario.request.parameters) {
    if (!value.empty()) out << fmt::format("  here: {} = {}\n", name, value);
  }
  const bool box = scenario.problem->container == ContainerNames::box;  // the container represents these walls
  if (const auto& walls = scenario.request.walls; walls && !box) {
    for (const Walls::Interval& wall : walls->intervals) {
      out << fmt::format("  here: {} {} {} from {} to {}\n", wall_keys().wall_rule.name,
                         wall_rules()[static_cast<std::size_t>(walls->rule)], wall.coordinate,
                         wall.min.empty() ? "-infinity" : wall.min, wall.max.empty() ? "infinity" : wall.max);
    }
  }
  if (!scenario.request.method.name.empty()) {
    const MethodSpec taken = method_taken(scenario.request);
    if (taken.options != scenario.request.method.options) {
      out << fmt::format(
          "  here: steps are solved by iteration = \"{}\", which costs less than newton because most second "
          "derivatives of H are 0\n",
          taken.options.at("iteration"));
    }
  }
  const auto list = [](const std::vector<double>& xs) { return joined(xs, shortest); };
  constexpr std::size_t most_shown = 100;
  const ProblemEntry& problem = *scenario.problem;
  out << fmt::format("  start: q = [{}], p = [{}]{}\n",
                     scenario.start_q.size() > most_shown ? fmt::format("{} numbers", scenario.start_q.size())
                                                          : list(scenario.start_q),
                     scenario.start_p.size() > most_shown ? fmt::format("{} numbers", scenario.start_p.size())
                                                          : list(scenario.start_p),
                     problem.energy ? ", H = " + shortest(problem.energy(scenario.request.parameters, scenario.start_q,
                                                                         scenario.start_p))
                                    : "");
}

/// Writes the ways to give the start of a run.
void write_starts(std::ostream& out, const ProblemInfo& info) {
  if (!info.start_key.empty()) {
    out << fmt::format("  {} = 1, ..., {}, each with its own keys:\n", info.start_key, info.starts.size());
  } else if (!info.starts.empty()) {
    out << "  orbit = { kind = ..., direction = 1 or -1 } with\n";
  }
  for (const StartInfo& s : info.starts) {
    out << fmt::format("    {:<18} {}  {}\n", s.kind.empty() ? "(without kind)" : s.kind, fmt::join(s.keys, ", "),
                       s.meaning);
  }
  if (info.two_bodies) {
    out << "  bodies = [{ mass, position = [3], velocity = [3] }, { ... }]: two bodies in space, reduced\n";
  }
  out << fmt::format("  initial = {{ q = [{0}], p = [...] }} or {{ q, v }}{1}\n", fmt::join(info.coordinates, ", "),
                     info.default_q.empty() || info.default_p.empty()
                         ? ""
                         : fmt::format("; default q = [{}], p = [{}]", fmt::join(info.default_q, ", "),
                                       fmt::join(info.default_p, ", ")));
  out << "    { q, p = [\"+\", ...], energy = E } computes one component of p or v from the energy: \"+\" is the "
         "largest, \"-\" the smallest root of H = E\n";
}

/// Writes the walls of a problem and the keys of walls.
void write_walls(std::ostream& out, const ProblemEntry& entry) {
  const ProblemInfo& info = entry.info;
  const WallKeys& keys = wall_keys();
  const bool fixed = !info.walls.empty();
  if (!fixed && !entry.constraint_form.empty()) return;  // walls and constraints exclude each other
  for (const FixedWall& wall : info.walls) {
    out << fmt::format("  walls: {} from {} to {}\n", info.coordinates.at(wall.coordinate), wall.min, wall.max);
  }
  if (!fixed) {
    out << fmt::format("  {} = [{{ {} = \"{}\", {}, {} }}]: walls, with\n", keys.walls.name, keys.coordinate.name,
                       info.coordinates.front(), keys.min.name, keys.max.name);
  }
  for (const OptionInfo* key : {&keys.wall_rule, &keys.strength, &keys.exponent}) out << option_row(*key);
  for (const auto& [name, text] : info.observables) out << fmt::format("  observable: {} = {}\n", name, text);
}

/// Writes the constraints of a typed problem. Other problems have them in their formulas.
void write_constraints(std::ostream& out, const ProblemEntry& entry) {
  const FormulaTexts texts = formula_texts({entry.info.variant.begin(), entry.info.variant.end()});
  for (const std::string& text : texts.constraints) out << fmt::format("  constraint: {} = 0\n", text);
  if (!texts.constraints.empty()) {
    out << fmt::format("  {}: {}\n", FormulaKeys::constraint_form, texts.constraint_form);
  }
}

void write_problem(std::ostream& out, const ProblemEntry& entry) {
  const ProblemInfo& info = entry.info;
  out << fmt::format("{}{}\n  {}\n  degrees of freedom: {}; source: {}\n", info.name,
                     variant_of(entry).empty() ? "" : " with " + variant_text(entry), info.formula,
                     degrees_of_freedom(entry), info.reference);
  if (entry.structure) out << "  found: " << structure_text(*entry.structure) << "\n";
  if (!info.parameters.empty() || !info.frame.name.empty()) out << "  keys of [problem]:\n";
  for (const OptionInfo& key : keys_of(info)) out << option_row(key);
  if (!info.frame.name.empty()) out << option_row(info.frame);
  if (!info.velocities.name.empty()) out << option_row(info.velocities);
  write_starts(out, info);
  write_walls(out, entry);
  out << fmt::format("  momenta: {}\n",
                     entry.momenta.empty() ? joined(info.coordinates, declared_momentum) : joined(entry.momenta));
  const bool typed = has_typed_hamiltonian(entry);
  if (typed) write_constraints(out, entry);
  for (const InvariantInfo& i : info.invariants) {
    out << fmt::format("  {}: {} = {}\n", typed ? "watched" : "conserved", i.name, i.meaning);
  }
}

/// Writes a problem with a choice that can be typed, for example the potential.
void write_typed_choice(std::ostream& out, const ProblemInfo& info) {
  out << fmt::format(
      "{0} with {1} = \"formula\" and any {2}: you type the {1}, e.g. {3} (hamflow show formula explains formulas)\n",
      info.name, info.typed_choice, info.chart_key, info.formula);
  for (const OptionInfo& option : keys_of(info)) out << option_row(option);
  write_starts(out, info);
}

void write_method(std::ostream& out, const MethodSpec& spec) {
  const MethodInfo info = describe(spec);
  out << fmt::format("{}\n  {}\n  order {}, {}\n  source: {}\n", info.name, info.summary, info.order, flags(info),
                     info.reference);
  if (info.forces_per_step > 0) out << fmt::format("  force evaluations per step: {}\n", info.forces_per_step);
  const MethodEntry& entry = find_method(spec.name);
  out << "  needs " << entry.family->needs(entry.index) << "\n";
  const MethodAdvice said = advice(spec);
  if (!said.purpose.empty()) out << filled("for " + said.purpose);
  if (!said.take.empty()) out << filled("use it where " + said.take);
  if (!said.avoid.empty()) out << filled("do not use it where " + said.avoid);
  const std::vector<OptionInfo>& options = entry.family->options;
  if (!options.empty()) out << "  keys of [method]:\n";
  for (const OptionInfo& option : options) out << option_row(option);
  out << "  measured properties: hamflow verify " << (info.name == spec.name ? info.name : "'" + info.name + "'")
      << "\n";
}

/// Returns the line of a method in the list of all methods.
std::string method_row(const MethodEntry& entry) {
  const MethodInfo info = describe(MethodSpec{.name = entry.name});
  return fmt::format("{:<16} order {:<3} {:<34} {}\n", entry.name, info.order, flags(info), info.summary);
}

/// Writes the recommended methods with their purposes; then the names of all others, family by family.
void write_methods(std::ostream& out) {
  const std::vector<std::string> first = first_methods();
  out << "Recommended methods (hamflow show NAME describes one):\n\n";
  for (const std::string& name : first) {
    const MethodInfo info = describe(MethodSpec{.name = name});
    out << fmt::format("{:<10} order {:<3} {}\n", name, info.order, advice(MethodSpec{.name = name}).purpose);
  }
  out << "\nAll other methods (hamflow list methods --all describes each in one line):\n";
  for (const MethodFamily& family : method_families()) {
    std::vector<std::string> others;
    for (const std::string& name : family.methods) {
      if (std::find(first.begin(), first.end(), name) == first.end()) others.push_back(name);
    }
    if (!others.empty()) out << '\n' << filled(family.name + ": " + family.meaning) << filled(joined(others), 4);
  }
}

void write_all_methods(std::ostream& out) {
  for (const MethodFamily& family : method_families()) {
    out << (&family == method_families().data() ? "" : "\n") << family.name << ": " << family.meaning << '\n';
    for (const MethodEntry& entry : methods()) {
      if (entry.family == &family) out << method_row(entry);
    }
  }
}

Json methods_as_json() {
  Json all = Json::array();
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

Json problems_as_json() {
  Json all = Json::array();
  for (const ProblemEntry& entry : problems()) {
    all.push_back({{"name", entry.info.name},
                   {"variant", variant_of(entry)},
                   {"formula", entry.info.formula},
                   {"degrees_of_freedom", entry.dimension}});
  }
  return all;
}

void write_problems(std::ostream& out) {
  for (const ProblemEntry& entry : problems()) {
    out << fmt::format("{:<26} {}{}\n", entry.info.name, entry.info.formula,
                       variant_of(entry).empty() ? "" : "  (" + variant_text(entry) + ")");
  }
  for (const ProblemEntry& entry : typed_examples()) {
    if (entry.to_reference) continue;
    out << fmt::format("{:<26} {}  ({} = \"formula\", an example)\n", entry.info.name, entry.info.formula,
                       entry.info.typed_choice);
  }
}

}  // namespace

std::string methods_text(bool all) {
  std::ostringstream out;
  (all ? write_all_methods : write_methods)(out);
  return out.str();
}

std::string problems_text() {
  std::ostringstream out;
  write_problems(out);
  return out.str();
}

std::string methods_json() { return methods_as_json().dump(2) + "\n"; }
std::string problems_json() { return problems_as_json().dump(2) + "\n"; }

std::optional<CatalogueText> catalogue_text(const std::string& name) {
  std::ostringstream out;
  std::vector<std::string> formulas;
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name != name) continue;
    if (entry.structure) {
      write_formula(out, entry);
      continue;
    }
    write_problem(out, entry);
    const std::string formula = tex_of(entry.info.formula);
    if (std::find(formulas.begin(), formulas.end(), formula) == formulas.end()) formulas.push_back(formula);
  }
  for (const ProblemEntry& entry : typed_examples()) {
    if (entry.info.name == name && !entry.to_reference) write_typed_choice(out, entry.info);
  }
  const std::string of_problem = out.str();
  if (!of_problem.empty()) return CatalogueText{of_problem, formulas};
  if (write_keys(out, name)) return CatalogueText{out.str()};
  for (const FigureKindInfo& kind : figure_kinds()) {
    if (kind.name != name) continue;
    return CatalogueText{fmt::format(
        "{0}\n  a figure: {1}\n  drawn by hamflow plot RUN --kind {0}, or by output.figures = [\"{0}\"] in a "
        "scenario\n",
        name, kind.meaning)};
  }
  const auto is_named = [&](const MethodEntry& entry) { return entry.name == name.substr(0, name.find('(')); };
  if (std::none_of(methods().begin(), methods().end(), is_named)) return std::nullopt;
  write_method(out, parse_method(name));
  return CatalogueText{out.str()};
}

CatalogueText description_of(const Scenario& scenario) {
  std::ostringstream out;
  write_scenario(out, scenario);
  return {out.str(), {tex_of(scenario.problem->info.formula)}};
}

std::string not_in_catalogue(const std::string& name, const std::vector<std::string>* experiments) {
  std::vector<std::string> names;
  for (const ProblemEntry& entry : problems()) names.push_back(entry.info.name);
  for (const FigureKindInfo& kind : figure_kinds()) names.push_back(kind.name);
  for (const MethodEntry& entry : methods()) names.push_back(entry.name);
  for (const DeclaredTable& table : declared_tables()) names.push_back(table.name);
  if (experiments != nullptr) names.insert(names.end(), experiments->begin(), experiments->end());
  return fmt::format("there is no problem, method{} '{}'{} ({}, {}{}; keys: {}, {})",
                     experiments == nullptr ? " or figure" : ", figure or experiment", name,
                     suggested_name(name.substr(0, name.find('(')), names), command_name("list problems"),
                     command_name("list methods"),
                     experiments == nullptr ? "" : ", " + command_name("list experiments"), command_name("show run"),
                     command_name("show output"));
}

}  // namespace hamflow
