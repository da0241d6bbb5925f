#include "pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "text.hpp"

namespace hamflow::figures {

namespace {
constexpr std::size_t most_dots = 400;          // of a cloud
constexpr std::size_t most_dots_on_line = 200;  // more would hide the line
constexpr std::size_t most_path_points = 12000;
constexpr double padding = 0.06;
const std::string energy_name = "{/:Italic H}";
const std::string energy_start = "{/:Italic H}_0";
const std::string time_name = "{/:Italic t}";

/// Samples without an exact curve: dots, or a line where there are many and the chords between them show the path.
Series samples(const Curve& track) {
  if (track.x.size() > most_dots_on_line) {
    const Curve path = thin_out(track, most_path_points);
    if (follows_path(path)) return {Ink::path, "", path};
  }
  return {Ink::fine_dots, "", thin_out(track, most_dots)};
}

/// Dots about a millimetre apart in print, so that the exact line shows between them.
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

/// Over time: one line over all samples; dots as well while they can be told apart.
Panel over_time(const std::vector<double>& t, const std::vector<double>& y) {
  Panel panel;
  const Curve curve = finite_points(t, y, Gaps::kept);
  Extent times;
  times.include(curve.x);
  panel.x = fit_axis(times, 0, {7, 40});
  panel.x_label = time_name;
  panel.aspect = 0.52;
  panel.series.push_back({Ink::line, "", envelope(curve, 1200)});
  if (curve.x.size() <= 40) panel.series.push_back({Ink::dots, "", curve});
  return panel;
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

/// Both axes with one scale: the box takes the shape of the data, within limits.
void fit_equal_axes(Panel& panel, const Extent& x, const Extent& y) {
  const int exponent = common_exponent(std::max(x.largest(), y.largest()));
  const double x_low = scaled(x.low, exponent);
  const double x_high = scaled(x.high, exponent);
  const double y_low = scaled(y.low, exponent);
  const double y_high = scaled(y.high, exponent);
  const double size = std::max({std::abs(x_low), std::abs(x_high), std::abs(y_low), std::abs(y_high)});
  const double longest = std::max(x_high - x_low, y_high - y_low);
  double margin = padding * longest;
  if (longest <= 1e-5 * size) margin = 0.1 * size;
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

Panel phase_panel(const FigureData& data, std::size_t i, std::size_t columns) {
  const Curve track = finite_points(data.q[i], data.p[i]);
  Extent q;
  Extent p;
  q.include(track.x);
  p.include(track.y);
  Panel panel;
  panel.x = fit_axis(q, padding, columns == 1 ? TickRoom{7, 40} : TickRoom{5, 18});
  panel.y = fit_axis(p, padding, {columns == 1 ? 7U : 5U});
  panel.x_label = symbol(data.coordinates[i]);
  panel.y_label = momentum_symbol(data.coordinates[i]);
  panel.aspect = columns == 1 ? 0.7 : 1;
  const bool exact = data.hamiltonian_1d && data.q.size() == 1 && std::isfinite(start_of(data.energy));
  if (!exact) {
    panel.series.push_back(samples(track));
    return panel;
  }
  const auto raw = [](const Axis& axis) {
    const double unit_half = std::pow(10.0, axis.exponent / 2);
    const double unit_rest = std::pow(10.0, axis.exponent - axis.exponent / 2);
    return Extent{axis.low * unit_half * unit_rest, axis.high * unit_half * unit_rest};
  };
  const double level = data.energy.empty() ? data.hamiltonian_1d(track.x[0], track.y[0]) : data.energy[0];
  panel.series.push_back({Ink::exact, "exact, " + energy_name + " = " + energy_start,
                          level_curve(data.hamiltonian_1d, level, raw(panel.x), raw(panel.y))});
  panel.series.push_back({Ink::dots, "numeric", dots_on_line(track, panel)});
  return panel;
}

}  // namespace

std::vector<double> relative_energy_error(const FigureData& data) {
  const double start = start_of(data.energy);
  const double scale = scale_of(data);
  std::vector<double> error;
  for (const double h : data.energy) {
    const double difference = h - start;
    error.push_back(std::isinf(difference) ? h / scale - start / scale : difference / scale);
  }
  return error;
}

/// The paths of several bodies, seen along the third axis where there is one.
Page bodies_page(const FigureData& data) {
  Extent x;
  Extent y;
  std::vector<Curve> tracks;
  for (std::size_t i = 0; i + 1 < data.q.size(); i += data.space) {
    tracks.push_back(finite_points(data.q[i], data.q[i + 1]));
    x.include(tracks.back().x);
    y.include(tracks.back().y);
  }
  Panel panel;
  fit_equal_axes(panel, x, y);
  panel.x_label = symbol("x");
  panel.y_label = symbol("y");
  for (const Curve& track : tracks) panel.series.push_back(samples(track));
  return {data.title, {panel}, 1};
}

Page orbit_page(const FigureData& data) {
  if (data.space >= 2) return bodies_page(data);
  const Curve track = orbit_track(data);
  const bool exact = !data.curve_x.empty();
  Extent x;
  Extent y;
  x.include(track.x);
  y.include(track.y);
  Panel panel;
  if (exact) {
    x.include(data.curve_x);
    y.include(data.curve_y);
    x.include(0);
    y.include(0);
  }
  fit_equal_axes(panel, x, y);
  const bool polar = is_polar(data);
  panel.x_label = polar ? symbol("x") : symbol(data.coordinates[0]);
  panel.y_label = polar ? symbol("y") : symbol(data.coordinates[1]);
  if (exact) {
    panel.series.push_back({Ink::exact, "exact", {data.curve_x, data.curve_y}});
    panel.series.push_back({Ink::dots, "numeric", dots_on_line(track, panel)});
    panel.series.push_back({Ink::centre, "", {{0}, {0}}});
  } else {
    panel.series.push_back(samples(track));
  }
  return {data.title, {panel}, 1};
}

Page energy_page(const FigureData& data) {
  Panel panel = over_time(data.t, data.energy);
  Extent range;
  range.include(data.energy);
  const double scale = std::max(scale_of(data), range.largest());
  // Below a thousandth of the scale the labels would differ in their last digits only: then the energy is shown as the
  // constant it is, and its error is told in words.
  if (range.high / scale - range.low / scale < 1e-3) {
    double worst = 0;
    for (const double e : relative_energy_error(data)) {
      if (std::isfinite(e)) worst = std::max(worst, std::abs(e));
    }
    const std::string divisor = scale_name(data);
    const double start = start_of(data.energy);
    if (std::isfinite(start)) {
      panel.note = fmt::format("max |{} − {}|{}{} = {}", energy_name, energy_start, divisor.empty() ? "" : "/", divisor,
                               short_number(worst));
    }
    constexpr double most = std::numeric_limits<double>::max();
    range.include(std::max(start - scale, -most));
    range.include(std::min(start + scale, most));
  }
  panel.y = fit_axis(range, padding, {6});
  panel.y_label = energy_name;
  return {data.title, {panel}, 1};
}

Page energy_error_page(const FigureData& data) {
  const std::vector<double> error = relative_energy_error(data);
  Panel panel = over_time(data.t, error);
  Extent range;
  range.include(error);
  range.include(0);
  constexpr double rounding = 1e-15;
  const bool at_rounding = range.largest() < rounding;
  if (at_rounding) {  // single roundings must not look like a signal
    range.include(-rounding);
    range.include(rounding);
  }
  panel.y = fit_axis(range, at_rounding ? 0 : padding, {6});
  const std::string divisor = scale_name(data);
  const std::string difference = energy_name + " − " + energy_start;
  panel.y_label = divisor.empty() ? difference : "(" + difference + ")/" + divisor;
  Extent times;
  times.include(data.t);
  panel.series.insert(panel.series.begin(), {Ink::zero, "", {{times.low, times.high}, {0, 0}}});
  return {data.title, {panel}, 1};
}

Page condition_page(const FigureData& data) {
  const std::vector<std::pair<std::string, std::string>> labels{{"condition_tangent", "cond_∞({/:Italic K}_T)"},
                                                                {"determinant_tangent", "det({/:Italic K}_T)"},
                                                                {"condition_inverse_mass", "cond_∞({/:Italic M}^{−1})"},
                                                                {"iterations", "Newton iterations"}};
  Page page{data.title, {}, 1};
  for (const auto& [name, label] : labels) {
    for (const auto& [column, values] : data.diagnostics) {
      if (column != name || finite_points(data.t, values).x.empty()) continue;
      Panel panel = over_time(data.t, values);
      Extent range;
      range.include(values);
      panel.y = fit_axis(range, padding, {5});
      panel.y_label = label;
      page.panels.push_back(panel);
    }
  }
  return page;
}

Page phase_page(const FigureData& data) {
  Page page;
  page.title = data.title;
  page.columns = data.q.size() == 1 ? 1 : 2;
  for (std::size_t i = 0; i < data.q.size(); ++i) page.panels.push_back(phase_panel(data, i, page.columns));
  return page;
}

Page section_page(const FigureData& data) {
  constexpr std::size_t most_points = 20000;
  const Curve points = finite_points(data.section_q, data.section_p);
  Extent q;
  Extent p;
  q.include(points.x);
  p.include(points.y);
  Panel panel;
  panel.x = fit_axis(q, padding, {7, 40});
  panel.y = fit_axis(p, padding, {7});
  panel.x_label = symbol(data.section_coordinate);
  panel.y_label = momentum_symbol(data.section_coordinate);
  panel.aspect = 0.8;
  panel.series.push_back({Ink::fine_dots, "", thin_out(points, most_points)});
  return {data.title, {panel}, 1};
}

}  // namespace hamflow::figures
