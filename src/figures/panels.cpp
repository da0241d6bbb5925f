#include "panels.hpp"

#include <algorithm>
#include <cmath>

#include "text.hpp"

namespace hamflow::figures {

namespace {
constexpr std::size_t most_dots = 400;          // of a cloud
constexpr std::size_t most_dots_on_line = 200;  // more would hide the line
constexpr std::size_t most_path_points = 12000;
const std::string time_name = "{/:Italic t}";
}  // namespace

Series samples(const Curve& track) {
  if (track.x.size() > most_dots_on_line) {
    const Curve path = thin_out(track, most_path_points);
    if (follows_path(path)) return {Ink::path, "", path};
  }
  return {Ink::fine_dots, "", thin_out(track, most_dots)};
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

Panel over_time(const std::vector<double>& t, const std::vector<double>& y) {
  Panel panel;
  const Curve curve = finite_points(t, y, Gaps::kept);
  Extent times;
  times.include(curve.x);
  panel.x = fit_axis(times, 0, {7, 40});
  panel.x_label = time_name;
  panel.aspect = 0.52;
  panel.series.push_back({Ink::line, "", envelope(curve, 1200)});
  if (curve.x.size() <= most_separate_dots) panel.series.push_back({Ink::dots, "", curve});
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

std::string no_samples(const std::string& quantity) { return "there is no sample with a finite " + quantity; }

}  // namespace hamflow::figures
