// hamflow list, hamflow show: the catalogue as it is declared.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "figure_kinds.hpp"
#include "guarded.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/state_names.hpp"
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

std::string variant_text(const ProblemInfo& info) {
  return joined(info.variant, [](const auto& choice) { return choice.first + " = \"" + choice.second + "\""; });
}

/// Of what `coordinates` declares: a name, (z1), or dots.
std::string declared_momentum(const std::string& coordinate) {
  if (coordinate == "...") return coordinate;
  if (coordinate.front() != '(') return momentum_name(coordinate);
  return "(" + momentum_name(coordinate.substr(1));
}

void show_problem(const ProblemEntry& entry) {
  const ProblemInfo& info = entry.info;
  std::cout << fmt::format("{}{}\n  {}\n  degrees of freedom: {}; source: {}\n", info.name,
                           info.variant.empty() ? "" : " with " + variant_text(info), info.formula,
                           entry.dimension > 0 ? std::to_string(entry.dimension) : "as many as the start has",
                           info.reference);
  if (!info.parameters.empty()) std::cout << "  keys of [problem]:\n";
  for (const ParameterInfo& parameter : info.parameters) std::cout << option_row(parameter);
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
  std::cout << fmt::format(
      "  initial = {{ q = [{0}], p = [...] }} or {{ q, v }}{1}\n", fmt::join(info.coordinates, ", "),
      info.default_q.empty() ? ""
                             : fmt::format("; default q = [{}], p = [{}]", fmt::join(info.default_q, ", "),
                                           fmt::join(info.default_p, ", ")));
  std::cout << fmt::format("  momenta: {}\n", joined(info.coordinates, declared_momentum));
  for (const InvariantInfo& i : info.invariants) std::cout << fmt::format("  conserved: {} = {}\n", i.name, i.meaning);
}

void show_method(const MethodSpec& spec) {
  const MethodInfo info = describe(spec);
  std::cout << fmt::format("{}\n  {}\n  order {}, {}\n  source: {}\n", info.name, info.summary, info.order, flags(info),
                           info.reference);
  if (info.forces_per_step > 0) std::cout << fmt::format("  force evaluations per step: {}\n", info.forces_per_step);
  const std::vector<OptionInfo>& options = find_method(spec.name).family->options;
  if (!options.empty()) std::cout << "  keys of [method]:\n";
  for (const OptionInfo& option : options) std::cout << option_row(option);
  std::cout << "  measured properties: hamflow verify " << (info.name == spec.name ? info.name : "'" + info.name + "'")
            << "\n";
}

}  // namespace

int list_command(const std::string& what, bool json) {
  return guarded(json, [&] {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    if (what == "methods") {
      for (const MethodEntry& entry : methods()) {
        const MethodInfo info = describe(MethodSpec{.name = entry.name});
        if (json) {
          all.push_back({{"name", entry.name},
                         {"order", info.order},
                         {"explicit", info.explicit_step},
                         {"symplectic", info.symplectic},
                         {"symmetric", info.symmetric},
                         {"summary", info.summary}});
        } else {
          std::cout << fmt::format("{:<14} order {:<3} {:<34} {}\n", entry.name, info.order, flags(info), info.summary);
        }
      }
    } else {
      for (const ProblemEntry& entry : problems()) {
        if (json) {
          all.push_back({{"name", entry.info.name},
                         {"variant", entry.info.variant},
                         {"formula", entry.info.formula},
                         {"degrees_of_freedom", entry.dimension}});
        } else {
          std::cout << fmt::format("{:<26} {}{}\n", entry.info.name, entry.info.formula,
                                   entry.info.variant.empty() ? "" : "  (" + variant_text(entry.info) + ")");
        }
      }
    }
    if (json) std::cout << all.dump(2) << '\n';
    return exit_done;
  });
}

int show_command(const std::string& name) {
  return guarded(false, [&] {
    bool found = false;
    std::vector<std::string> names;
    for (const ProblemEntry& entry : problems()) {
      names.push_back(entry.info.name);
      if (entry.info.name != name) continue;
      show_problem(entry);
      found = true;
    }
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
      throw Error("there is no problem, method or figure '" + name + "'" + suggestion(method, names) +
                  " (hamflow list problems, hamflow list methods; keys: hamflow show run, hamflow show output)");
    }
    show_method(parse_method(name));
    return exit_done;
  });
}

}  // namespace hamflow::app
