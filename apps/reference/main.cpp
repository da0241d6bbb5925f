// Prints docs/reference.md from the declarations of problems, methods and keys; ./dev docs writes the file, and a test
// compares it with what this program prints.
#include <fmt/format.h>

#include <iostream>
#include <span>

#include "figure_kinds.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/run/formula_options.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/walls.hpp"
#include "method_keys.hpp"
#include "run_keys.hpp"

namespace {

using namespace hamflow;

/// A text inside a cell of a table.
std::string cell(const std::string& text) {
  std::string all;
  for (const char c : text) all += c == '|' ? std::string("\\|") : std::string(1, c);
  return all;
}

std::string rows(std::span<const OptionInfo> options, const std::string& before = "") {
  std::string text;
  for (const OptionInfo& option : options) {
    std::string meaning = option.meaning;
    if (!option.unit.empty()) meaning += ", in units of " + option.unit;
    if (!option.condition.empty()) meaning += "; " + option.condition;
    if (option.free_on_resume) meaning += "; may change with --resume";
    text += fmt::format("| `{}{}` | {} | {} | {} |\n", before, option.name, cell(allowed_text(option)),
                        cell(default_text(option)), cell(meaning));
    text += rows(option.keys, before + option.name + ".");
  }
  return text;
}

std::string table(std::span<const OptionInfo> options) {
  return "| key | allowed | default | meaning |\n|---|---|---|---|\n" + rows(options) + "\n";
}

std::string flags(const MethodInfo& info) {
  std::string text = info.explicit_step ? "explicit" : "implicit";
  if (info.symplectic) text += ", symplectic";
  if (info.symmetric) text += ", symmetric";
  return text;
}

std::string starts(const ProblemInfo& info) {
  if (info.starts.empty()) return "";
  std::string text = info.start_key.empty() ? "Starts, `orbit = { kind = ..., direction = 1 or -1 }` with:\n\n"
                                            : "Starts, `" + info.start_key + " = 1, ...` with:\n\n";
  text += "| start | keys | meaning |\n|---|---|---|\n";
  for (const StartInfo& start : info.starts) {
    text +=
        fmt::format("| {} | {} | {} |\n", start.kind.empty() ? "(without kind)" : "`" + start.kind + "`",
                    joined(start.keys, [](const std::string& key) { return "`" + key + "`"; }), cell(start.meaning));
  }
  return text + "\n";
}

/// A start of its own has as many as every other.
std::string degrees_of_freedom(const ProblemEntry& entry) {
  const std::size_t n = entry.dimension > 0 ? static_cast<std::size_t>(entry.dimension) : entry.info.default_q.size();
  if (!entry.constraint_form.empty()) return std::to_string(n) + ", minus one for each constraint";
  return n > 0 ? std::to_string(n) : "given by the start";
}

/// The problem whose Hamiltonian is typed.
std::string typed_problem(const ProblemEntry& example) {
  std::string text =
      fmt::format("### {}\n\nA Hamiltonian that you type, e.g. `{}`.\n\n", example.info.name, example.info.formula);
  text += table(keys_of(example.info));
  for (const std::string& sentence : formula_language()) text += "- " + sentence + "\n";
  return text + "\n`initial = { q, p }` with canonical momenta, or `{ q, v }` with velocities.\n\n";
}

std::string problem(const ProblemEntry& entry) {
  if (entry.structure) return typed_problem(entry);
  const ProblemInfo& info = entry.info;
  const auto is_number = [](const std::string& x) { return x.find_first_not_of("0123456789") == std::string::npos; };
  const std::string variant = joined(info.variant, [&](const auto& choice) {
    const std::string quote = is_number(choice.second) ? "" : "\"";
    return choice.first + " = " + quote + choice.second + quote;
  });
  std::string text = fmt::format("### {}{}\n\n{}\n\n", info.name, variant.empty() ? "" : ", " + variant, info.formula);
  text += fmt::format("Degrees of freedom: {}. Coordinates: {}. Source: {}.\n\n", degrees_of_freedom(entry),
                      joined(info.coordinates), info.reference);
  std::vector<OptionInfo> keys(keys_of(info).begin(), keys_of(info).end());
  if (!info.frame.name.empty()) keys.push_back(info.frame);
  if (!info.velocities.name.empty()) keys.push_back(info.velocities);
  if (!keys.empty()) text += table(keys);
  text += starts(info);
  if (info.two_bodies) {
    text += "`bodies = [{ mass, position = [3], velocity = [3] }, { ... }]`: two bodies in space, reduced.\n\n";
  }
  text += "`initial = { q, p }` with canonical momenta, or `{ q, v }` with velocities";
  if (!info.default_q.empty() && !info.default_p.empty() && info.default_q.size() <= 4) {
    text += fmt::format("; default q = [{}], p = [{}]", joined(info.default_q), joined(info.default_p));
  } else if (!info.default_q.empty() && info.velocities.name.empty()) {
    text += "; default: the problem's own";
  }
  text += ".\n\n";
  for (const FixedWall& wall : info.walls) {
    text += fmt::format("Walls: {} from {} to {}.\n\n", info.coordinates.at(wall.coordinate), wall.min, wall.max);
  }
  for (const auto& [name, expression] : info.observables) {
    text += fmt::format("Observable, averaged over every step: {} = {}.\n\n", name, expression);
  }
  for (const InvariantInfo& invariant : info.invariants) {
    text += fmt::format("Conserved: {} = {}.\n\n", invariant.name, invariant.meaning);
  }
  return text;
}

std::string methods_of(const MethodFamily& family) {
  std::string text = "### " + family.name + "\n\n| method | order | | |\n|---|---|---|---|\n";
  for (std::size_t i = 0; i < family.methods.size(); ++i) {
    const MethodInfo info = family.describe(i, {});
    text += fmt::format("| `{}` | {} | {} | {} |\n", family.methods[i], info.order, flags(info), cell(info.summary));
  }
  text += "\n";
  if (!family.options.empty()) text += table(family.options);
  std::vector<OptionInfo> with_position = family.options;
  std::erase_if(with_position, [](const OptionInfo& option) { return option.position == 0; });
  const std::string by_position = joined(option_names(with_position));
  if (!by_position.empty()) text += "By position: " + family.methods.front() + "(" + by_position + ").\n\n";
  return text;
}

/// "run.dt" and so on, a line each: what tools/check_options.py looks for.
std::string keys() {
  std::string text;
  for (const std::string& name : all_method_keys()) text += "method." + name + "\n";
  for (const DeclaredTable& declared : declared_tables()) {
    for (const OptionInfo& key : declared.keys) text += declared.name + "." + key.name + "\n";
  }
  return text;
}

std::string page() {
  std::string text =
      "# Reference\n\nMade by `./dev docs` from the declarations in the code; a test compares the two. Keys stand in "
      "the tables of a\nscenario; numbers may be given as texts such as \"1/3\" or \"2*pi/100\".\n\n## [problem]\n\n"
      "One component of p, or of v, may be computed from the energy: `initial = { q = [0, 0.1], p = [\"+\", 0.1],\n"
      "energy = 0.125 }`. `\"+\"` is the largest and `\"-\"` the smallest root of H = energy. If H is not quadratic "
      "in the\ncomponent, the root is searched at 0, at 128 points for each power of 2 from 2^-20 to 2^20, at four "
      "points for each\nfrom 2^-100 to 2^100, with both signs, and between these points where H comes near the energy. "
      "Narrower dips are not\nseen. If H oscillates, as cos(p) does, the start is refused.\n\n";
  for (const ProblemEntry& entry : problems()) text += problem(entry);
  for (const ProblemEntry& entry : typed_examples()) {
    if (entry.to_reference) continue;
    text += fmt::format(
        "### {0}, {1} = \"formula\"\n\nYou type the {1}, e.g. {2}, with any `{3}`.\nThe start is `initial`, "
        "`bodies` or, if V does not depend on t, `orbit` with energy and angular momentum.\n\n",
        entry.info.name, entry.info.typed_choice, entry.info.formula, entry.info.chart_key);
    text += table(entry.info.keys);
  }
  const WallKeys& walls = wall_keys();
  text +=
      "### Walls, of any problem\n\nThe walls of `t-tube` are fixed; only their rule can be set. With hard walls a run "
      "leaves out the invariants that\na wall breaks, closed solutions and properties of the orbit, and `compare` "
      "measures errors against a motion whose\nbounces are located.\n\n";
  text += table(std::vector<OptionInfo>{walls.walls, walls.wall_rule, walls.strength, walls.exponent});
  text += "## [method]\n\n`name` is one of the methods below; options may follow it, as in \"cg(1,5)\".\n\n";
  for (const MethodFamily& family : method_families()) text += methods_of(family);
  for (const DeclaredTable& declared : declared_tables())
    text += "## [" + declared.name + "]\n\n" + table(declared.keys);
  text += "## Figures\n\n| kind | what is drawn |\n|---|---|\n";
  for (const FigureKindInfo& kind : figure_kinds()) text += "| `" + kind.name + "` | " + cell(kind.meaning) + " |\n";
  text += "\n## Arithmetics\n\n" + joined(arithmetics()) + ".\n\n";
  text += "## What --resume may change\n\n";
  for (const DeclaredTable& declared : declared_tables()) {
    for (const OptionInfo& key : declared.keys) {
      if (key.free_on_resume) text += "- `" + declared.name + "." + key.name + "`\n";
    }
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  std::cout << (argc > 1 && std::string(argv[1]) == "--keys" ? keys() : page());
  return 0;
}
