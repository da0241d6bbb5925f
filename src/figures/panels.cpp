#include "panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "text.hpp"

namespace hamflow::figures {

namespace {
constexpr std::size_t most_dots = 20000;        // in a scatter plot
constexpr std::size_t most_dots_on_line = 200;  // more dots would hide the line
constexpr std::size_t most_path_points = 12000;
constexpr std::size_t page_columns = 400;  // columns of 0.2 mm in a journal's column

/// Returns whether a path looks like a point on any axes, also if it only moves by rounding.
bool is_point(const Curve& curve) {
  constexpr double rounding = 1e-14;
  Extent x;
  Extent y;
  x.include(curve.x);
  y.include(curve.y);
  const double largest = std::max(x.largest(), y.largest());
  const auto is_short = [&](const Extent& range) {
    return !(range.high - range.low > std::max(resolvable * range.largest(), rounding * largest));
  };
  return !curve.x.empty() && is_short(x) && is_short(y);
}
/// Returns whether a line over the samples would fill the area, because it turns several times in each column of the
/// page.
bool fills_area(const Curve& curve) {
  std::size_t turns = 0;
  for (std::size_t k = 2; k < curve.y.size(); ++k) {
    if ((curve.y[k] - curve.y[k - 1]) * (curve.y[k - 1] - curve.y[k - 2]) < 0) ++turns;
  }
  return turns > 4 * page_columns;
}
}  // namespace

Series series_of(const Figure& figure, std::size_t run) {
  if (figure.runs.size() < 2) return {};
  return {.name = escaped(figure.runs[run].label), .mark = mark_of(run)};
}

namespace {
/// Draws a point, because a line without length would be invisible.
Series point_of(const Curve& track, Series how) {
  how.ink = Ink::place;
  how.curve = {{track.x.front()}, {track.y.front()}};
  return how;
}
}  // namespace

Series track_of(const Curve& track, Series how) {
  if (is_point(track)) return point_of(track, std::move(how));
  const Curve path = thin_out(track, most_path_points);
  if (track.x.size() > 2 && follows_path(path)) {
    how.ink = Ink::path;
    how.curve = path;
    return how;
  }
  how.ink = track.x.size() > most_separate_dots ? Ink::fine_dots : Ink::place;
  how.curve = thin_out(track, most_dots);
  return how;
}

bool is_whole_run(const FigureSamples& first_steps, const FigureData& data) {
  if (first_steps.t.empty() || data.t.empty()) return true;
  const double end = std::isfinite(data.end) ? data.end : data.t.back();
  constexpr double rounding = 1e-9;  // rounding of a time that is a sum of steps
  return std::abs(first_steps.t.back()) >= (1 - rounding) * std::abs(end);
}

FirstStepLines first_step_lines_of(const Figure& figure) {
  return {.whole_run = std::all_of(figure.runs.begin(), figure.runs.end(),
                                   [](const FigureData& run) { return is_whole_run(run.first_steps, run); })};
}

std::vector<Series> tracks_of(const std::vector<Curve>& tracks, const std::vector<Curve>& openings,
                              std::vector<Series> how, FirstStepLines& drawn) {
  bool first_steps_only = !tracks.empty();
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    how[k] = track_of(tracks[k], std::move(how[k]));
    first_steps_only = first_steps_only && how[k].ink != Ink::path;
  }
  bool moves = false;
  for (std::size_t k = 0; first_steps_only && k < tracks.size(); ++k) {
    const bool rests = is_point(openings[k]);
    first_steps_only = rests || follows_path(openings[k]);
    moves = moves || !rests;
  }
  if (!first_steps_only || !moves) return how;
  drawn.any = true;
  std::vector<Series> all;
  for (std::size_t k = 0; k < tracks.size() && !drawn.whole_run; ++k) {
    if (how[k].ink != Ink::fine_dots && how[k].ink != Ink::place) continue;
    Series& dots = all.emplace_back(how[k]);  // drawn below the line, they show the rest of the run
    dots.ink = Ink::fine_dots;
    dots.name.clear();
    dots.opacity = 0.5;
  }
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    if (is_point(openings[k])) {
      all.push_back(point_of(openings[k], std::move(how[k])));
      continue;
    }
    how[k].ink = Ink::path;
    how[k].curve = openings[k];
    all.push_back(std::move(how[k]));
  }
  return all;
}

void note_first_steps(Page& page, const FigureData& data) {
  if (is_whole_run(data.first_steps, data)) return;
  const double end = std::isfinite(data.end) ? data.end : data.t.back();
  page.notes.push_back("line: the first steps, to {/:Italic t} = " + short_value(data.first_steps.t.back()) + " of " +
                       short_value(end));
  page.notes.push_back("dots: the samples of the whole run");
}

void include_drawn(const std::vector<Series>& drawn, Extent& x, Extent& y) {
  for (const Series& series : drawn) {
    x.include(series.curve.x);
    y.include(series.curve.y);
  }
}

std::string joined_note(std::size_t samples) { return "lines join " + std::to_string(samples) + " samples"; }

bool is_sparse(const std::vector<double>& y) {
  constexpr std::size_t few = 8;
  Extent range;
  range.include(y);
  if (y.size() < 2 || range.empty() || range.high - range.low <= resolvable * range.largest()) return false;
  if (y.size() < few) return true;
  const double step = 0.1 * (range.high - range.low);
  std::size_t turns = 0;
  for (std::size_t k = 2; k < y.size(); ++k) {
    const double before = y[k - 1] - y[k - 2];
    const double after = y[k] - y[k - 1];
    if (before * after < 0 && std::abs(before) > step && std::abs(after) > step) ++turns;
  }
  return 3 * turns > y.size();
}

Curve dots_on_line(const Curve& track, const Panel& panel) {
  constexpr double width = 68;
  Curve printed;
  for (std::size_t k = 0; k < track.x.size(); ++k) {
    printed.add(width * scaled(track.x[k], panel.x.exponent) / (panel.x.high - panel.x.low),
                width * panel.aspect * scaled(track.y[k], panel.y.exponent) / (panel.y.high - panel.y.low));
  }
  const double most = most_dots_on_line;
  return thin_out(track, static_cast<std::size_t>(std::clamp(path_length(printed), 40.0, most)));
}

FigureUnits units_of(const Figure& figure) {
  const FigureUnits& first = figure.runs.front().units;
  const bool shared =
      std::all_of(figure.runs.begin(), figure.runs.end(), [&](const FigureData& run) { return run.units == first; });
  return shared ? first : FigureUnits{};
}

std::string in_unit(const std::string& label, const std::string& unit) {
  return unit.empty() ? label : label + " in " + unit;
}

std::string time_label(const Figure& figure) { return in_unit("{/:Italic t}", units_of(figure).t); }

Panel panel_over(const Extent& times, const std::string& label) {
  Panel panel;
  panel.x = fit_axis(times, 0, {7, 40});
  panel.x_label = label;
  panel.aspect = 0.52;
  return panel;
}

void add_over_time(Panel& panel, const std::vector<double>& t, const std::vector<double>& y, Series how) {
  how.curve = finite_points(t, y, Gaps::kept);
  how.ink = Ink::line;
  if (how.curve.x.size() > 4 * page_columns && fills_area(how.curve)) {
    const Band band = envelope(how.curve, page_columns);
    how.ink = Ink::band;
    how.curve = {band.x, band.low};
    how.value = band.high;
  }
  panel.series.push_back(how);
  if (how.curve.x.size() > most_separate_dots) return;
  how.ink = Ink::dots;
  how.name.clear();
  panel.series.push_back(how);
}

double start_of(const std::vector<double>& energy) { return energy.empty() ? 0 : energy.front(); }

double scale_of(const FigureData& data) {
  return std::isfinite(data.energy_scale) && data.energy_scale > 0 ? data.energy_scale : 1;
}

std::string scale_name(const FigureData& data) {
  const double scale = scale_of(data);
  const double start = std::abs(start_of(data.energy));
  if (scale == 1) return "";
  return std::abs(scale - start) <= 1e-12 * scale ? "|" + energy_start + "|" : "(|{/:Italic T}_0| + |{/:Italic V}_0|)";
}

void fit_equal_axes(Panel& panel, const Extent& x, const Extent& y) {
  const int exponent = common_exponent(std::max(x.largest(), y.largest()));
  const double x_low = scaled(x.low, exponent);
  const double x_high = scaled(x.high, exponent);
  const double y_low = scaled(y.low, exponent);
  const double y_high = scaled(y.high, exponent);
  const double size = std::max({std::abs(x_low), std::abs(x_high), std::abs(y_low), std::abs(y_high)});
  const double longest = std::max(x_high - x_low, y_high - y_low);
  double margin = padding * longest;
  if (longest <= resolvable * size) margin = 0.1 * size;
  if (!(size > 0)) margin = 1;
  double width = x_high - x_low + 2 * margin;
  double height = y_high - y_low + 2 * margin;

  constexpr double flattest = 0.45;
  constexpr double steepest = 1.2;
  width = std::max(width, height / steepest);
  height = std::max(height, width * flattest);
  const double x_middle = 0.5 * (x_low + x_high);
  const double y_middle = 0.5 * (y_low + y_high);
  panel.x = plain_axis(x_middle - 0.5 * width, x_middle + 0.5 * width, {7, 40});
  panel.y = plain_axis(y_middle - 0.5 * height, y_middle + 0.5 * height, {7});
  if (height > 0.75 * width) panel.x.step = panel.y.step = std::max(panel.x.step, panel.y.step);
  panel.x.exponent = panel.y.exponent = exponent;
  panel.aspect = height / width;
  panel.equal_axes = true;
}

std::vector<double> relative_energy_error(const FigureData& data) {
  const double start = start_of(data.energy);
  const double scale = scale_of(data);
  std::vector<double> error;
  for (const double difference : data.energy_difference) error.push_back(difference / scale);
  if (!error.empty()) return error;
  for (const double h : data.energy) {
    const double difference = h - start;
    error.push_back(std::isinf(difference) ? h / scale - start / scale : difference / scale);
  }
  return error;
}

std::string energy_error_label(const FigureData& data) {
  const std::string divisor = scale_name(data);
  const std::string difference = energy_name + " − " + energy_start + (data.has_time ? energy_of_time : "");
  return divisor.empty() ? difference : "(" + difference + ")/" + divisor;
}

std::string no_samples(const std::string& quantity) { return "there is no sample with a finite " + quantity; }

}  // namespace hamflow::figures
