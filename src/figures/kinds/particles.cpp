// Positions of particles or bodies at the first and the last sample, or at chosen times, with their container.
#include "../particles.hpp"

#include <algorithm>
#include <cmath>

#include "../draw_style.hpp"
#include "../figure_kind.hpp"
#include "../panels.hpp"
#include "../text.hpp"

namespace hamflow::figures {

namespace particles {
constexpr std::size_t most_drawn = 20000;

std::vector<std::size_t> samples(const Figure& figure) {
  const FigureData& data = figure.runs.front();
  if (!figure.options.at.empty()) return samples_at(data, figure.options.at);
  if (data.t.size() == 3) return {0, 1, 2};  // start, turn and end of a reversal
  if (data.t.size() == 1) return {0};
  return {0, data.t.size() - 1};
}

Ink dot(std::size_t count) {
  if (count <= 200) return Ink::place;
  return count <= 2000 ? Ink::dots : Ink::fine_dots;
}

/// @param ends extents over all drawn samples, for each axis, so that all panels have one scale
Panel panel_of(const FigureData& data, const std::vector<double>& positions, Plane plane,
               const std::vector<Extent>& ends, std::size_t sample) {
  const FigureParticles& of = data.particles;
  Panel panel;
  fit_equal_axes(panel, ends[plane.first], ends[plane.second]);
  panel.x.step = plain_axis(panel.x.low, panel.x.high, {5, 18}).step;  // up to three panels are next to each other
  const std::vector<std::string> names = axes_of_space(of.space);
  panel.x_label = in_unit(symbol(names[plane.first]), data.units.q) + ",  " + time_text(data.t[sample]) +
                  (data.units.t.empty() ? "" : " " + data.units.t);
  panel.y_label = in_unit(symbol(names[plane.second]), data.units.q);
  if (Curve around = outline(of, plane); !around.x.empty()) panel.series.push_back({Ink::exact, "", around});
  const std::vector<std::size_t> drawn = some_of(of.count, most_drawn);
  if (!of.gas && of.count <= 12) {
    for (const std::size_t i : drawn) {
      const std::string name = i < data.bodies.size() ? escaped(data.bodies[i]) : "body " + std::to_string(i + 1);
      const Curve place{{positions[i * of.space + plane.first]}, {positions[i * of.space + plane.second]}};
      panel.series.push_back({Ink::place, name, place, mark_of(i)});
    }
    return panel;
  }
  Curve places;
  for (const std::size_t i : drawn) {
    const double x = positions[i * of.space + plane.first];
    const double y = positions[i * of.space + plane.second];
    if (std::isfinite(x) && std::isfinite(y)) places.add(x, y);
  }
  panel.series.push_back({dot(places.x.size()), "", places});
  return panel;
}

Page page(const Figure& figure) {
  const FigureData& data = figure.runs.front();
  const FigureParticles& of = data.particles;
  const std::vector<Plane> planes = chosen_planes(figure.options, axes_of_space(of.space), of.space == 2);
  const std::vector<std::size_t> shown = samples(figure);
  std::vector<std::vector<double>> positions;
  std::vector<Extent> ends(of.space);
  for (const std::size_t sample : shown) {
    positions.push_back(folded(of.positions(sample), of));
    for (std::size_t i = 0; i < positions.back().size(); ++i) ends[i % of.space].include(positions.back()[i]);
  }
  for (const Plane& plane : planes) {
    const Curve around = outline(of, plane);
    ends[plane.first].include(around.x);
    ends[plane.second].include(around.y);
  }
  Page all{data.title, {}};
  for (std::size_t k = 0; k < shown.size(); ++k) {
    for (const Plane& plane : planes) all.panels.push_back(panel_of(data, positions[k], plane, ends, shown[k]));
  }
  if (all.panels.size() > 1) {
    all.columns = planes.size() == 3 || shown.size() == 3 ? 3 : 2;
    all.width = two_columns;
  }
  // Only the first panel has a legend.
  for (std::size_t k = 1; k < all.panels.size(); ++k) {
    for (Series& series : all.panels[k].series) series.name.clear();
  }
  if (const std::string note = part_note(std::min(of.count, most_drawn), of.count); !note.empty())
    all.notes.push_back(note);
  return all;
}
}  // namespace particles

extern const FigureKind particles_figure{
    "particles",
    "the positions of the particles of a gas and their container, at the start and "
    "the end or at the times of --at",
    8,
    without_particles,
    no_places,
    one_run,
    axes_of_particles,
    particles::page,
    true};

}  // namespace hamflow::figures
