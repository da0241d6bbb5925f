// hamflow list, hamflow show: the catalogue as its own declarations tell it.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow::app {

namespace {

std::string flags(const MethodInfo& info) {
  std::string text = info.explicit_step ? "explicit" : "implicit";
  if (info.symplectic) text += ", symplectic";
  if (info.symmetric) text += ", symmetric";
  return text;
}

std::string variant_text(const ProblemInfo& info) {
  std::string text;
  for (const auto& [key, value] : info.variant) text += (text.empty() ? "" : ", ") + key + " = \"" + value + "\"";
  return text;
}

void show_problem(const ProblemEntry& entry) {
  const ProblemInfo& info = entry.info;
  std::cout << fmt::format("{}{}\n  {}\n  degrees of freedom: {}; source: {}\n", info.name,
                           info.variant.empty() ? "" : " with " + variant_text(info), info.formula,
                           entry.dimension > 0 ? std::to_string(entry.dimension) : "as many as the start has",
                           info.reference);
  if (!info.parameters.empty()) std::cout << "  keys of [problem]:\n";
  for (const ParameterInfo& p : info.parameters) {
    const char* range = p.range == Range::positive       ? ", positive"
                        : p.range == Range::not_negative ? ", not negative"
                        : p.range == Range::count        ? ", a whole number from 1"
                                                         : "";
    const std::string list = p.kind == ParameterKind::number ? ""
                             : p.length > 0                  ? fmt::format(", a list of {}", p.length)
                             : p.kind == ParameterKind::list ? ", a list"
                                                             : ", a number or a list";
    std::cout << fmt::format("    {:<18} [{}]{}{}  {}\n", p.name,
                             p.required                ? "required"
                             : p.default_value.empty() ? "not given"
                                                       : p.default_value,
                             range, list, p.meaning);
  }
  if (!info.start_key.empty()) {
    std::cout << fmt::format("  {} = 1, ..., {}, each with its keys beside it:\n", info.start_key, info.starts.size());
  } else if (!info.starts.empty()) {
    std::cout << "  orbit = { kind = ..., direction = 1 or -1 } with\n";
  }
  for (const StartInfo& s : info.starts) {
    std::cout << fmt::format("    {:<18} {}  {}\n", s.kind.empty() ? "(without kind)" : s.kind, fmt::join(s.keys, ", "),
                             s.meaning);
  }
  if (info.name == "central-force") {
    std::cout << "  bodies = [{ mass, position = [3], velocity = [3] }, { ... }]: two bodies in space, reduced\n";
  }
  std::cout << fmt::format(
      "  initial = {{ q = [{0}], p = [...] }} or {{ q, v }}{1}\n", fmt::join(info.coordinates, ", "),
      info.default_q.empty() ? ""
                             : fmt::format("; default q = [{}], p = [{}]", fmt::join(info.default_q, ", "),
                                           fmt::join(info.default_p, ", ")));
  for (const InvariantInfo& i : info.invariants) std::cout << fmt::format("  conserved: {} = {}\n", i.name, i.meaning);
}

void show_method(const MethodSpec& spec) {
  const MethodInfo info = describe(spec);
  std::cout << fmt::format("{}\n  {}\n  order {}, {}\n  source: {}\n", info.name, info.summary, info.order, flags(info),
                           info.reference);
  if (info.forces_per_step > 0) std::cout << fmt::format("  force evaluations per step: {}\n", info.forces_per_step);
  if (spec.name == "cg") {
    std::cout
        << "  keys of [method]:\n"
           "    degree             [1]         polynomial degree in time: 1 in this version\n"
           "    quadrature         [auto]      Gauss points, degree to 64, or \"auto\": the fewest that keep H at "
           "rounding\n"
           "    tolerance          [unset]     on the 2-norm of the residual (2.63); unset: its rounding level\n"
           "    criterion          [stagnation] \"seed\": stagnation above the tolerance is an error\n"
           "    max_iterations     [15]\n"
           "    iteration          [newton]\n"
           "    on_divergence      [error]     \"halve\": two half steps in place of one that does not converge\n"
           "    diagnostics        [false]     condition and determinant of the tangent, condition of M^-1, each "
           "step\n";
  }
  std::cout << "  measured properties: hamflow verify " << (spec.name == "cg" ? "'" + info.name + "'" : info.name)
            << "\n";
}

}  // namespace

int list_command(const std::string& what, bool json) {
  return guarded(json, [&] {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    if (what == "methods") {
      for (const MethodEntry& entry : methods()) {
        const MethodInfo info = describe(MethodSpec{entry.name, {}});
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
    if (found) return exit_done;
    for (const MethodEntry& entry : methods()) names.push_back(entry.name);
    const bool known = std::find(names.begin(), names.end(), name) != names.end();
    if (!known && name.find('(') == std::string::npos) {
      const std::string near = nearest(name, names);
      throw Error("there is no problem or method '" + name + "'" +
                  (near.empty() ? "" : "; did you mean " + near + "?") +
                  " (hamflow list problems, hamflow list methods)");
    }
    show_method(parse_method(name));
    return exit_done;
  });
}

}  // namespace hamflow::app
