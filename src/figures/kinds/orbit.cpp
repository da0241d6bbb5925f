// Path in the plane of the two coordinates, with the exact orbit if it is known; paths of bodies in space, in the
// planes of its axes.
#include <algorithm>
#include <cmath>

#include "../figure_kind.hpp"
#include "../panels.hpp"
#include "../planes.hpp"
#include "../text.hpp"
#include "hamflow/figures/curves.hpp"

namespace hamflow::figures {

namespace orbit {
constexpr std::size_t most_named_bodies = 12;

std::string refused(const FigureFacts& facts) {
  const bool drawn = facts.degrees_of_freedom == 0 || facts.degrees_of_freedom == 2 || facts.bodies_in_space;
  return drawn ? "" : for_degrees(facts) + ", where an orbit needs 2, or bodies in space";
}

std::string obstacle(const FigureData& data) {
  const Curve track = data.space >= 2 ? finite_points(data.q[0], data.q[1]) : orbit_track(data);
  return track.x.empty() ? no_samples("position") : "";
}

std::size_t bodies(const FigureData& data) { return data.space < 2 ? 1 : data.q.size() / data.space; }

std::string body_name(const FigureData& data, std::size_t body) {
  return body < data.bodies.size() ? escaped(data.bodies[body]) : "body " + std::to_string(body + 1);
}

std::string apart(const Figure& figure) {
  const FigureData& first = figure.runs.front();
  for (const FigureData& run : figure.runs) {
    if (bodies(run) > 1) return "colours mark the bodies of one run; allowed several runs of one body, or a single run";
    if (is_polar(run) != is_polar(first) && run.coordinates != std::vector<std::string>{"x", "y"} &&
        first.coordinates != std::vector<std::string>{"x", "y"}) {
      return same_coordinates(figure);
    }
  }
  const bool plane = std::all_of(figure.runs.begin(), figure.runs.end(), [](const FigureData& run) {
    return is_polar(run) || run.coordinates == std::vector<std::string>{"x", "y"};
  });
  return plane ? "" : same_coordinates(figure);
}

/// Returns the axes of space, or the two coordinates.
std::vector<std::string> columns(const FigureData& data) {
  if (data.space >= 2) return axes_of_space(data.space);
  return is_polar(data) ? std::vector<std::string>{"x", "y"} : data.coordinates;
}

bool is_flat(const FigureData& data, std::size_t axis) {
  for (std::size_t i = axis; i < data.q.size(); i += data.space) {
    if (std::any_of(data.q[i].begin(), data.q[i].end(), [](double x) { return std::isfinite(x) && x != 0; })) {
      return false;
    }
  }
  return true;
}

/// Returns the chosen planes. By default these are all planes of space, or only that of the first two axes if the
/// motion stays in it.
std::vector<Plane> planes(const Figure& figure) {
  const FigureData& data = figure.runs.front();
  const bool in_plane = data.space == 3 && std::all_of(figure.runs.begin(), figure.runs.end(),
                                                       [](const FigureData& run) { return is_flat(run, 2); });
  return chosen_planes(figure.options, columns(data), in_plane || data.space < 3);
}

Curve in_plane(const FigureData& data, const FigureSamples& samples, std::size_t body, Plane plane) {
  if (samples.q.size() != data.q.size()) return {};
  if (is_polar(data)) {
    Curve track = polar_track(samples);
    if (plane.first > plane.second) std::swap(track.x, track.y);
    return track;
  }
  const std::size_t first = body * data.space;
  return finite_points(samples.q[first + plane.first], samples.q[first + plane.second]);
}

/// The exact curve of a single sample is a point, and is not drawn.
bool has_exact(const FigureData& data) {
  Extent x;
  Extent y;
  x.include(data.curve_x);
  y.include(data.curve_y);
  return x.low < x.high || y.low < y.high;
}

/// Extent in each direction of space, over everything that is drawn.
using Extents = std::vector<Extent>;

Panel panel_of(const Figure& figure, Plane plane, bool with_names, const Extents& shared, FirstStepLines& opened) {
  const FigureData& one = figure.runs.front();
  const bool exact = figure.runs.size() == 1 && has_exact(one) && plane == Plane{0, 1};
  Panel panel;
  Extent x;
  Extent y;
  std::vector<Curve> paths;
  std::vector<Curve> openings;
  std::vector<Series> hows;
  for (std::size_t run = 0; run < figure.runs.size(); ++run) {
    const FigureData& data = figure.runs[run];
    for (std::size_t body = 0; body < bodies(data); ++body) {
      Series how = series_of(figure, run);
      if (bodies(data) > 1) {
        how.mark = mark_of(body);
        if (bodies(data) <= most_named_bodies) how.name = body_name(data, body);
      }
      if (!with_names) how.name.clear();
      const FigureSamples& samples = data;
      paths.push_back(in_plane(data, data.path.q.empty() ? samples : data.path, body, plane));
      x.include(paths.back().x);
      y.include(paths.back().y);
      openings.push_back(in_plane(data, data.first_steps, body, plane));
      hows.push_back(how);
    }
  }
  std::vector<Series> tracks;
  if (exact) {
    for (const Curve& path : paths) tracks.push_back({Ink::dots, "numeric", path});
  } else {
    tracks = tracks_of(paths, openings, std::move(hows), opened);
    include_drawn(tracks, x, y);
  }
  if (exact) {
    x.include(one.curve_x);
    y.include(one.curve_y);
    x.include(0);
    y.include(0);
  }
  if (!shared.empty()) {
    x = shared[plane.first];
    y = shared[plane.second];
  }
  fit_equal_axes(panel, x, y);
  const std::vector<std::string> names = columns(one);
  panel.x_label = in_unit(symbol(names[plane.first]), units_of(figure).q);
  panel.y_label = in_unit(symbol(names[plane.second]), units_of(figure).q);
  if (exact) {
    panel.series.push_back({Ink::exact, "exact", {one.curve_x, one.curve_y}});
    tracks[0].curve = dots_on_line(tracks[0].curve, panel);
  }
  panel.series.insert(panel.series.end(), tracks.begin(), tracks.end());
  for (const Series& track : tracks) {  // marks where a body ends, because several bodies may follow the same path
    if (bodies(one) < 2 || track.curve.x.empty() || track.ink != Ink::path || opened.any) continue;
    panel.series.push_back({Ink::place, "", {{track.curve.x.back()}, {track.curve.y.back()}}, track.mark});
  }
  if (exact) panel.series.push_back({Ink::centre, "", {{0}, {0}}});
  return panel;
}

Extent widened(const Extent& extent, double length) {
  const double middle = 0.5 * (extent.low + extent.high);
  const double half = 0.5 * std::max(length, extent.high - extent.low);
  return {middle - half, middle + half};
}

/// Returns one range for each direction of space, the same in every plane. The horizontal ranges have the same length,
/// so that all planes have one scale.
Extents shared_extents(const Figure& figure) {
  Extents all(3);
  for (const FigureData& run : figure.runs) {
    for (const FigureSamples* samples : {static_cast<const FigureSamples*>(&run), &run.path, &run.first_steps}) {
      for (std::size_t i = 0; i < samples->q.size(); ++i) all[i % 3].include(samples->q[i]);
    }
  }
  const double longest = std::max(all[0].high - all[0].low, all[1].high - all[1].low);
  return {widened(all[0], longest), widened(all[1], longest), all[2]};
}

Page page(const Figure& figure) {
  Page all{figure.runs.front().title, {}};
  FirstStepLines opened = first_step_lines_of(figure);
  const std::vector<Plane> chosen = planes(figure);
  const bool shares = figure.runs.front().space == 3 && chosen.size() > 1;
  const Extents shared = shares ? shared_extents(figure) : Extents{};
  for (const Plane& plane : chosen) {
    all.panels.push_back(panel_of(figure, plane, all.panels.empty(), shared, opened));
  }
  if (all.panels.size() > 1) {
    all.columns = 2;
    all.width = two_columns;
  }
  if (opened.any) note_first_steps(all, figure.runs.front());
  return all;
}
}  // namespace orbit

extern const FigureKind orbit_figure{"orbit",
                                     "the path in the plane for 2 degrees of freedom, or the paths of bodies in space",
                                     1,
                                     orbit::refused,
                                     orbit::obstacle,
                                     orbit::apart,
                                     orbit::columns,
                                     orbit::page,
                                     false,
                                     true};

}  // namespace hamflow::figures
