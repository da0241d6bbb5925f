// One kind of figure. A file in kinds/, for example energy_error.cpp, defines `energy_error_figure`. Its functions are
// in a namespace `energy_error`, because several files may be compiled as one.
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
  int place;  // position in lists; the first kind that can be drawn is the default
  /// Returns what makes the kind impossible for such a run, as a text that follows `found "name"`, for example " for a
  /// problem with 1 degree of freedom"; empty if it is possible.
  std::string (*refused)(const FigureFacts&);
  /// Returns what is wrong with the samples of a run, a sentence; empty if nothing is. Only called if `refused` is
  /// empty.
  std::string (*obstacle)(const FigureData&);
  /// Explains why runs that can be drawn one by one cannot share a figure, a sentence; empty if they can.
  std::string (*apart)(const Figure&);
  /// Returns the columns that --x and --y may name, for the first run; empty: the kind draws no columns.
  std::vector<std::string> (*columns)(const FigureData&);
  Page (*page)(const Figure&);
  bool takes_times = false;   // accepts --at
  bool needs_states = false;  // needs q and p, which are not read for very many particles
};

/// Returns all kinds, sorted by place.
const std::vector<const FigureKind*>& all_kinds();
/// Returns null if no kind has that name.
const FigureKind* find_kind(const std::string& name);

/// `refused` for kinds that can be drawn of every run.
std::string never(const FigureFacts& facts);
/// `refused` for kinds that draw energies.
std::string without_energies(const FigureFacts& facts);
/// `apart` for kinds that any runs can share.
std::string any_runs(const Figure& figure);
/// `apart` for kinds that runs can share if their coordinates have the same names.
std::string same_coordinates(const Figure& figure);
/// `refused` for kinds that draw particles.
std::string without_particles(const FigureFacts& facts);
/// `obstacle` for kinds that draw particles: positions that are not finite.
std::string no_places(const FigureData& data);
/// `apart` for kinds that distinguish particles by colours.
std::string one_run(const Figure& figure);
/// `columns` for kinds that draw planes of space.
std::vector<std::string> axes_of_particles(const FigureData& data);
/// `columns` for kinds that draw no columns.
std::vector<std::string> no_columns(const FigureData& data);
/// Returns a text such as " for a problem with 3 degrees of freedom".
std::string for_degrees(const FigureFacts& facts);

}  // namespace hamflow::figures
