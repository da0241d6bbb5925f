// One kind of figure. A file in kinds/, say energy_error.cpp, defines `energy_error_figure`; its functions stand in the
// namespace `energy_error`, since several files may be compiled as one.
#pragma once

#include <string>
#include <vector>

#include "figure.hpp"
#include "figure_kinds.hpp"
#include "page.hpp"

namespace hamflow::figures {

struct FigureKind {
  const char* name;
  const char* meaning;
  int place;  // in lists; the first kind that can be drawn is the usual one
  /// What makes it impossible for such a run, to stand after `found "name"`, e.g. " for a problem with 1 degree of
  /// freedom"; empty if nothing does.
  std::string (*refused)(const FigureFacts&);
  /// What is wrong with the samples, a sentence; empty if nothing is. Asked only where `refused` is empty.
  std::string (*obstacle)(const FigureData&);
  Page (*page)(const FigureData&);
};

/// The kinds of the folder, sorted by place.
const std::vector<const FigureKind*>& all_kinds();
/// Null if there is none of that name.
const FigureKind* find_kind(const std::string& name);

/// `refused` of kinds that can be drawn of every run.
std::string never(const FigureFacts& facts);
/// " for a problem with 3 degrees of freedom".
std::string for_degrees(const FigureFacts& facts);

}  // namespace hamflow::figures
