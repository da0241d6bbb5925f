// **Kinds of figures** of a run: their names and meanings, and of which runs they can be drawn. Each kind is one file
// in kinds/, where the build finds it; scenarios, `plot`, `new`, `show` and the reference page read this table.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace hamflow {

/// What decides before a run whether a figure can be drawn of it.
struct FigureFacts {
  std::size_t degrees_of_freedom = 0;  // 0: not known yet, which refuses nothing
  bool bodies_in_space = false;        // q is [x1, y1(, z1), x2, ...] of several bodies
  bool diagnostics = false;            // method.diagnostics of an implicit method
  bool section = false;                // run.section
  bool stroboscopic = false;           // run.section, an expression of t alone
  bool columns_chosen = false;         // --y, of kinds that draw columns
  bool particles = false;              // of a gas, or several bodies in space
  bool gas = false;
  bool energies = true;  // stored, as a run does and a reversal does not
};

struct FigureKindInfo {
  std::string name;     // e.g. "energy-error"; also the name of the file in figures/
  std::string meaning;  // a phrase that says what is drawn, and of which runs
};

/// All kinds, in the order in which they are preferred when none is requested.
std::span<const FigureKindInfo> figure_kinds();
/// Their names, in the same order.
const std::vector<std::string>& figure_names();
/// The names of the kinds that can be drawn of such a run.
std::vector<std::string> drawable_figures(const FigureFacts& facts);

/// Empty if there is a kind of that name, else "found ...; allowed ...; did you mean ...?".
std::string unknown_figure(const std::string& kind);
/// Why such a run has no figure of that kind, "found ...; allowed ..."; empty if it has. Covers unknown kinds.
std::string refused_figure(const std::string& kind, const FigureFacts& facts);
/// The kind that is drawn when none is requested: the first that can be.
std::string usual_figure(const FigureFacts& facts);

}  // namespace hamflow
