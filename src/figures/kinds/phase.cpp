// Phase planes: each coordinate and its momentum, or the chosen columns. With one degree of freedom the level curve of
// H is drawn, too.
#include <algorithm>
#include <cmath>

#include "../columns.hpp"
#include "../figure_kind.hpp"
#include "../panels.hpp"
#include "../text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/figures/curves.hpp"

namespace hamflow::figures {

namespace phase {
constexpr std::size_t most_planes = 12;  // on one page
using Plane = std::pair<std::string, std::string>;

std::string refused(const FigureFacts& facts) {
  if (facts.columns_chosen || facts.degrees_of_freedom <= most_planes) return "";
  return for_degrees(facts) + ", of which at most " + std::to_string(most_planes) +
         " fit on a page; choose columns with " + option_name("x") + " and " + option_name("y");
}

std::string obstacle(const FigureData& data) {
  if (data.q.empty() || data.p.size() != data.q.size()) return "a phase plane needs a momentum for every coordinate";
  for (std::size_t i = 0; i < data.q.size(); ++i) {
    if (finite_points(data.q[i], data.p[i]).x.empty()) return no_samples("position and momentum");
  }
  return "";
}

std::vector<Plane> planes(const Figure& figure) {
  const FigureData& data = figure.runs.front();
  const FigureOptions& options = figure.options;
  std::vector<Plane> all;
  for (const std::string& y : options.y) all.emplace_back(options.x.empty() ? data.coordinates[0] : options.x, y);
  for (std::size_t i = 0; i < data.q.size() && options.y.empty(); ++i) {
    if (options.x.empty() || options.x == data.coordinates[i]) all.emplace_back(data.coordinates[i], data.momenta[i]);
  }
  if (all.empty()) all.emplace_back(options.x, data.momenta[0]);
  return all;
}

Curve in_plane(const FigureData& data, const Plane& plane) {
  return finite_points(column_of(data, plane.first).values(), column_of(data, plane.second).values());
}

constexpr double turn = 2 * 3.14159265358979323846;

/// Returns whether the coordinate is an angle that makes many turns; then it is folded, so that turns lie on top of
/// each other.
bool goes_round_often(const FigureData& data, const Extent& x) {
  constexpr double often = 4;  // turns; with fewer the level curve is readable without folding
  const bool is_angle = std::find(data.angles.begin(), data.angles.end(), data.coordinates[0]) != data.angles.end();
  return is_angle && x.high - x.low > often * turn;
}

/// Folds angles to -pi .. pi.
void fold(Curve& curve) {
  for (double& x : curve.x) x = std::remainder(x, turn);
}

/// Returns whether a coordinate runs through so many periods of H that the level curve has more waves across the panel
/// than the tracer resolves.
bool waves_too_finely(const Curve& track) {
  constexpr int most = 40;
  int extrema = 0;
  for (std::size_t i = 2; i < track.y.size(); ++i) {
    const bool runs_on = (track.x[i] - track.x[i - 1]) * (track.x[1] - track.x[0]) > 0;
    if (!runs_on) return false;
    if ((track.y[i] - track.y[i - 1]) * (track.y[i - 1] - track.y[i - 2]) < 0) ++extrema;
  }
  return extrema > most;
}

Curve first_steps_in_plane(const FigureData& data, const Plane& plane) {
  FigureData first_steps;
  static_cast<FigureSamples&>(first_steps) = data.first_steps;
  first_steps.coordinates = data.coordinates;
  first_steps.momenta = data.momenta;
  const std::vector<std::string> names = column_names(first_steps);
  const auto known = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (first_steps.t.empty() || !known(plane.first) || !known(plane.second)) return {};
  return in_plane(first_steps, plane);
}

/// Draws the level curve through the start, and the samples as dots on it.
void add_exact(Panel& panel, const FigureData& data, const Curve& track) {
  const auto raw = [](const Axis& axis) {
    const double unit_half = std::pow(10.0, axis.exponent / 2);
    const double unit_rest = std::pow(10.0, axis.exponent - axis.exponent / 2);
    return Extent{axis.low * unit_half * unit_rest, axis.high * unit_half * unit_rest};
  };
  const double level = data.energy.empty() ? data.hamiltonian_1d(track.x[0], track.y[0]) : data.energy[0];
  panel.series.push_back({Ink::exact, "exact, " + energy_name + " = " + energy_start,
                          level_curve(data.hamiltonian_1d, level, raw(panel.x), raw(panel.y))});
  panel.series.push_back({Ink::dots, "numeric", dots_on_line(track, panel)});
}

Panel phase_panel(const Figure& figure, const Plane& plane, std::size_t columns, bool with_names,
                  FirstStepLines& opened) {
  const FigureData& one = figure.runs.front();
  Panel panel;
  Extent x;
  Extent y;
  std::vector<Curve> tracks;
  std::vector<Curve> openings;
  for (const FigureData& run : figure.runs) {
    tracks.push_back(in_plane(run, plane));
    openings.push_back(first_steps_in_plane(run, plane));
    x.include(tracks.back().x);
    y.include(tracks.back().y);
  }
  const auto fit = [&] {
    panel.x = fit_axis(x, padding, columns == 1 ? TickRoom{7, 40} : TickRoom{5, 18});
    panel.y = fit_axis(y, padding, {columns == 1 ? 7U : 5U});
  };
  panel.x_label = axis_label(figure, column_of(one, plane.first));
  panel.y_label = axis_label(figure, column_of(one, plane.second));
  panel.aspect = columns == 1 ? 0.7 : 1;
  const bool whole = one.coordinates.size() == 1 && plane == Plane{one.coordinates[0], one.momenta[0]};
  if (whole && goes_round_often(one, x)) {
    panel.x_label += " mod 2π";
    x = {};
    for (std::vector<Curve>* curves : {&tracks, &openings}) std::for_each(curves->begin(), curves->end(), fold);
    for (const Curve& track : tracks) x.include(track.x);
  }
  const bool has_level_curve = whole && one.hamiltonian_1d && std::isfinite(start_of(one.energy));
  if (figure.runs.size() == 1 && has_level_curve && !waves_too_finely(tracks[0])) {
    x.include(openings[0].x);  // a few samples may miss most of the level curve
    y.include(openings[0].y);
    fit();
    add_exact(panel, one, tracks[0]);
    return panel;
  }
  std::vector<Series> how;
  for (std::size_t run = 0; run < figure.runs.size(); ++run) {
    how.push_back(series_of(figure, run));
    if (!with_names) how.back().name.clear();
  }
  panel.series = tracks_of(tracks, openings, std::move(how), opened);
  include_drawn(panel.series, x, y);
  fit();
  return panel;
}

Page page(const Figure& figure) {
  Page all;
  all.title = figure.runs.front().title;
  const std::vector<Plane> chosen = planes(figure);
  all.columns = chosen.size() == 1 ? 1 : 2;
  FirstStepLines opened = first_step_lines_of(figure);
  for (const Plane& plane : chosen) {
    all.panels.push_back(phase_panel(figure, plane, all.columns, all.panels.empty(), opened));
  }
  if (opened.any) note_first_steps(all, figure.runs.front());
  return all;
}
}  // namespace phase

extern const FigureKind phase_figure{"phase",
                                     "the phase plane (q, p) of each coordinate, or the columns of --x and --y",
                                     2,
                                     phase::refused,
                                     phase::obstacle,
                                     same_coordinates,
                                     column_names,
                                     phase::page,
                                     false,
                                     true};

}  // namespace hamflow::figures
