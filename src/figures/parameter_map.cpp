#include "parameter_map.hpp"

#include <algorithm>

#include "hamflow/core/error.hpp"
#include "page.hpp"
#include "panels.hpp"
#include "text.hpp"

namespace hamflow {

namespace {
using namespace figures;

/// Positive values over more than two decades have a logarithmic axis.
Axis value_axis(const std::vector<double>& values, double margin) {
  Extent extent;
  extent.include(values);
  if (extent.low > 0 && extent.high > 100 * extent.low) return log_axis(extent);
  return fit_axis(extent, margin, {7});
}

/// The extent of the points, and half the distance of neighbours more at either end: a pixel is a field round a point.
Extent of_fields(const std::vector<double>& xs) {
  Extent extent;
  extent.include(xs);
  std::vector<double> places = xs;
  std::sort(places.begin(), places.end());
  const auto count = std::unique(places.begin(), places.end()) - places.begin();
  if (count < 2) return extent;
  const double half = 0.5 * (extent.high - extent.low) / static_cast<double>(count - 1);
  return {extent.low - half, extent.high + half};
}

Panel curve_over(const ParameterMap& map) {
  Panel panel;
  Extent x;
  x.include(map.x);
  panel.x = fit_axis(x, 0.03, {7, 40});
  panel.y = value_axis(map.value, padding);
  panel.y_label = escaped(map.value_name);
  const Curve curve{map.x, map.value};
  panel.series.push_back({Ink::line, "", curve});
  if (map.x.size() <= most_separate_dots) panel.series.push_back({Ink::dots, "", curve});
  return panel;
}

Panel plane_over(const ParameterMap& map) {
  Panel panel;
  panel.x = fit_axis(of_fields(map.x), 0, {7, 60});
  panel.y = fit_axis(of_fields(map.y), 0, {7});
  panel.z = value_axis(map.value, 0);
  panel.y_label = escaped(map.y_name);
  panel.z_label = escaped(map.value_name);
  panel.aspect = 0.8;
  panel.series.push_back({.ink = Ink::map, .curve = {map.x, map.y}, .value = map.value});
  return panel;
}
}  // namespace

void write_parameter_map(const ParameterMap& map, const std::filesystem::path& file) {
  const std::string refused = refused_figure_file(file);
  if (!refused.empty()) throw Error(refused);
  Extent values;
  values.include(map.value);
  if (values.empty()) throw Error("there is nothing to draw: " + map.value_name + " has no finite value");
  Panel panel = map.y_name.empty() ? curve_over(map) : plane_over(map);
  panel.x_label = escaped(map.x_name);
  draw({map.title, {panel}, 1, map.y_name.empty() ? one_column : two_columns}, file);
}

}  // namespace hamflow
