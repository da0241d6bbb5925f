#include "figure_kinds.hpp"

#include <algorithm>

#include "figure_kind.hpp"
#include "figure_kind_list.hpp"  // the build generates it from the folder kinds/
#include "hamflow/core/text.hpp"

namespace hamflow {

namespace figures {
const std::vector<const FigureKind*>& all_kinds() {
  static const std::vector<const FigureKind*> sorted = [] {
    std::vector<const FigureKind*> all = generated_figure_kinds();
    std::stable_sort(all.begin(), all.end(), [](const auto* a, const auto* b) { return a->place < b->place; });
    return all;
  }();
  return sorted;
}

const FigureKind* find_kind(const std::string& name) {
  for (const FigureKind* kind : all_kinds()) {
    if (kind->name == name) return kind;
  }
  return nullptr;
}

std::string never(const FigureFacts&) { return {}; }

std::string without_energies(const FigureFacts& facts) {
  return facts.energies ? "" : ", but a reversal stores no energies";
}

std::string any_runs(const Figure&) { return {}; }

std::string same_coordinates(const Figure& figure) {
  const FigureData& first = figure.runs.front();
  for (const FigureData& run : figure.runs) {
    if (run.coordinates == first.coordinates) continue;
    return "the coordinates of " + first.label + " are " + joined(first.coordinates) + ", those of " + run.label + " " +
           joined(run.coordinates) + "; allowed runs with the same coordinates";
  }
  return {};
}

std::string without_particles(const FigureFacts& facts) {
  if (facts.particles || facts.degrees_of_freedom == 0) return {};
  return for_degrees(facts) + ", which is neither a gas nor several bodies in space";
}

std::string one_run(const Figure&) { return "this kind draws the particles of one run; allowed a single run"; }

std::vector<std::string> no_columns(const FigureData&) { return {}; }

std::string for_degrees(const FigureFacts& facts) {
  return " for a problem with " + std::to_string(facts.degrees_of_freedom) +
         (facts.degrees_of_freedom == 1 ? " degree of freedom" : " degrees of freedom");
}
}  // namespace figures

std::span<const FigureKindInfo> figure_kinds() {
  static const std::vector<FigureKindInfo> infos = [] {
    std::vector<FigureKindInfo> all;
    for (const figures::FigureKind* kind : figures::all_kinds()) all.push_back({kind->name, kind->meaning});
    return all;
  }();
  return infos;
}

const std::vector<std::string>& figure_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const FigureKindInfo& kind : figure_kinds()) all.push_back(kind.name);
    return all;
  }();
  return names;
}

std::vector<std::string> drawable_figures(const FigureFacts& facts) {
  std::vector<std::string> names;
  for (const figures::FigureKind* kind : figures::all_kinds()) {
    if (kind->refused(facts).empty()) names.emplace_back(kind->name);
  }
  // The particles are the most informative figure of a gas, so they come first.
  const auto particles = std::find(names.begin(), names.end(), "particles");
  if (facts.gas && particles != names.end()) std::rotate(names.begin(), particles, particles + 1);
  return names;
}

std::string unknown_figure(const std::string& kind) {
  if (figures::find_kind(kind) != nullptr) return {};
  return "found \"" + kind + "\"; allowed " + joined(figure_names()) + suggestion(kind, figure_names());
}

std::string refused_figure(const std::string& kind, const FigureFacts& facts) {
  const figures::FigureKind* known = figures::find_kind(kind);
  if (known == nullptr) return unknown_figure(kind);
  const std::string why = known->refused(facts);
  return why.empty() ? "" : "found \"" + kind + "\"" + why + "; allowed " + joined(drawable_figures(facts));
}

std::string usual_figure(const FigureFacts& facts) { return drawable_figures(facts).front(); }

}  // namespace hamflow
