// One kind of figure. A file in kinds/, say energy_error.cpp, defines `energy_error_figure`; its functions stand in the
// namespace `energy_error`, since several files may be compiled as one.
#pragma once

#include <string>
#include <vector>

#include "figure.hpp"
#include "figure_kinds.hpp"
#include "hamflow/figures/page.hpp"

namespace hamflow::figures {

struct FigureKind {
  const char* name;
  const char* meaning;
  int place;  // in lists; the first kind that can be drawn is the usual one
  /// What makes it impossible for such a run, to stand after `found "name"`, e.g. " for a problem with 1 degree of
  /// freedom"; empty if nothing does.
  std::string (*refused)(const FigureFacts&);
  /// What is wrong with the samples of a run, a sentence; empty if nothing is. Asked only where `refused` is empty.
  std::string (*obstacle)(const FigureData&);
  /// Why runs that can be drawn each by itself have no figure together, a sentence; empty if they have.
  std::string (*apart)(const Figure&);
  /// The columns that --x and --y may name, for the first run; empty: the kind draws no columns.
  std::vector<std::string> (*columns)(const FigureData&);
  Page (*page)(const Figure&);
  bool takes_times = false;   // --at
  bool needs_states = false;  // q and p, which of very many particles are not read
};

/// The kinds of the folder, sorted by place.
const std::vector<const FigureKind*>& all_kinds();
/// Null if there is none of that name.
const FigureKind* find_kind(const std::string& name);

/// `refused` of kinds that can be drawn of every run.
std::string never(const FigureFacts& facts);
/// `refused` of kinds that draw energies.
std::string without_energies(const FigureFacts& facts);
/// `apart` of kinds that any runs share.
std::string any_runs(const Figure& figure);
/// `apart` of kinds that runs share whose coordinates have the same names.
std::string same_coordinates(const Figure& figure);
/// `refused` of kinds that draw particles.
std::string without_particles(const FigureFacts& facts);
/// `obstacle` of these: positions that are not finite.
std::string no_places(const FigureData& data);
/// `apart` of kinds in which colours tell particles apart.
std::string one_run(const Figure& figure);
/// `columns` of kinds that draw planes of space.
std::vector<std::string> axes_of_particles(const FigureData& data);
/// `columns` of kinds without.
std::vector<std::string> no_columns(const FigureData& data);
/// " for a problem with 3 degrees of freedom".
std::string for_degrees(const FigureFacts& facts);

}  // namespace hamflow::figures
