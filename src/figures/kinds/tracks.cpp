// Paths of the particles of a gas, or of bodies, and their final positions.
#include <algorithm>
#include <cmath>

#include "../draw_style.hpp"
#include "../figure_kind.hpp"
#include "../panels.hpp"
#include "../particles.hpp"
#include "../text.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/figures/curves.hpp"

namespace hamflow::figures {

namespace tracks {
constexpr std::size_t most_tracks = 500;
constexpr std::size_t most_samples = 400;  // samples of a path; a page cannot show more

/// @param paths one for each drawn coordinate   @param sparse becomes true if chords do not follow a path
Panel panel_of(const FigureData& data, const std::vector<std::vector<double>>& paths, Plane plane, bool& sparse) {
  const FigureParticles& of = data.particles;
  const std::vector<std::string> names = axes_of_space(of.space);
  Panel panel;
  panel.x_label = in_unit(symbol(names[plane.first]), data.units.q);
  panel.y_label = in_unit(symbol(names[plane.second]), data.units.q);
  Extent x;
  Extent y;
  const Curve around = outline(of, plane);
  x.include(around.x);
  y.include(around.y);
  if (!around.x.empty()) panel.series.push_back({Ink::exact, "", around});
  std::vector<Series> ends;
  const std::size_t drawn = paths.size() / of.space;
  for (std::size_t i = 0; i < drawn; ++i) {
    Series path{Ink::path, "", finite_points(paths[i * of.space + plane.first], paths[i * of.space + plane.second]),
                mark_of(drawn == of.count ? i : static_cast<std::size_t>(counter_bits(2, i) % 8))};
    path.mark.dash = 1;
    if (path.curve.x.empty()) continue;
    sparse = sparse || (path.curve.x.size() > 1 && !follows_path(path.curve));
    x.include(path.curve.x);
    y.include(path.curve.y);
    ends.push_back({Ink::dots, "", {{path.curve.x.back()}, {path.curve.y.back()}}, path.mark});
    panel.series.push_back(std::move(path));
  }
  fit_equal_axes(panel, x, y);
  panel.series.insert(panel.series.end(), ends.begin(), ends.end());
  return panel;
}

Page page(const Figure& figure) {
  const FigureData& data = figure.runs.front();
  const FigureParticles& of = data.particles;
  const std::vector<std::size_t> drawn = some_of(of.count, most_tracks);
  const std::size_t samples = std::min(data.t.size(), most_samples);
  std::vector<std::vector<double>> paths(drawn.size() * of.space);
  for (std::size_t k = 0; k < samples; ++k) {
    const std::size_t sample = samples == 1 ? 0 : k * (data.t.size() - 1) / (samples - 1);
    const std::vector<double> q = of.positions(sample);
    for (std::size_t i = 0; i < paths.size(); ++i) {
      paths[i].push_back(q[drawn[i / of.space] * of.space + i % of.space]);
    }
  }
  bool sparse = false;
  Page all{data.title, {}};
  for (const Plane& plane : chosen_planes(figure.options, axes_of_space(of.space), of.space == 2)) {
    all.panels.push_back(panel_of(data, paths, plane, sparse));
  }
  if (all.panels.size() > 1) {
    all.columns = 2;
    all.width = two_columns;
  }
  if (const std::string note = part_note(drawn.size(), of.count); !note.empty()) all.notes.push_back(note);
  if (samples < data.t.size()) {
    all.notes.push_back("lines join " + std::to_string(samples) + " of " + std::to_string(data.t.size()) + " samples");
  } else if (sparse && !data.every_step) {
    all.notes.push_back(joined_note(samples));
  }
  if (of.container == "periodic") all.notes.push_back("paths are not folded into the periodic box");
  return all;
}
}  // namespace tracks

extern const FigureKind tracks_figure{"tracks",
                                      "the paths of the particles of a gas, with dots at their ends",
                                      9,
                                      without_particles,
                                      no_places,
                                      one_run,
                                      axes_of_particles,
                                      tracks::page};

}  // namespace hamflow::figures
