// **Kinds of figures** of a run: their names, their meanings, and the runs of which they can be drawn. Each kind is a
// file in kinds/, where the build finds it. Scenarios, `plot`, `new`, `show` and the reference page use this table.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace hamflow {

/// Facts that decide, before a run, whether a figure can be drawn of it.
struct FigureFacts {
  std::size_t degrees_of_freedom = 0;  // 0: not known yet; then no kind is refused
  bool bodies_in_space = false;        // q is [x1, y1(, z1), x2, ...] of several bodies
  bool diagnostics = false;            // method.diagnostics is set for an implicit method
  bool section = false;                // run.section is set
  bool stroboscopic = false;           // run.section is an expression of t alone
  bool columns_chosen = false;         // --y is given; for kinds that draw columns
  bool particles = false;              // the problem is a gas, or several bodies in space
  bool gas = false;
  bool energies = true;  // energies are stored; a reversal does not store them
};

struct FigureKindInfo {
  std::string name;     // for example "energy-error"; also the name of the file in figures/
  std::string meaning;  // a phrase that says what is drawn, and of which runs
};

/// Returns all kinds. Without a request the first one that can be drawn is used.
std::span<const FigureKindInfo> figure_kinds();
/// Returns their names in the same order.
const std::vector<std::string>& figure_names();
/// Returns the names of the kinds that can be drawn of such a run.
std::vector<std::string> drawable_figures(const FigureFacts& facts);

/// Returns an empty text if there is a kind of that name, otherwise "found ...; allowed ...; did you mean ...?".
std::string unknown_figure(const std::string& kind);
/// Explains why such a run has no figure of that kind, "found ...; allowed ..."; empty if it has. Covers unknown kinds.
std::string refused_figure(const std::string& kind, const FigureFacts& facts);
/// Returns the default kind, the first that can be drawn.
std::string usual_figure(const FigureFacts& facts);

}  // namespace hamflow
