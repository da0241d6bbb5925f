#include "time_panels.hpp"

#include "hamflow/figures/axis.hpp"
#include "hamflow/figures/curves.hpp"

namespace hamflow::reproduction {

using namespace figures;

namespace {
constexpr std::size_t most_dots = 400;
const std::string exact_colour = "#d55e00";

/// Fits an axis. If the values are almost equal, its range is so large that they look constant.
Axis axis_of(Extent range) {
  if (range.high - range.low < 1e-3 * range.largest()) {
    const double size = range.largest();
    range.include(range.low - size);
    range.include(range.high + size);
  }
  return fit_axis(range, padding, {6});
}
}  // namespace

Panel over_time(const std::string& label, const std::vector<double>& t, const std::vector<double>& x,
                const std::vector<double>& exact) {
  Extent times, range;
  times.include(t);
  range.include(x);
  range.include(exact);
  Panel panel = panel_over(times, "{/:Italic t}");
  panel.y = axis_of(range);
  panel.y_label = label;
  panel.aspect = 0.42;
  if (!exact.empty()) panel.series.push_back({Ink::line, "exact", finite_points(t, exact), {.colour = exact_colour}});
  panel.series.push_back({exact.empty() ? Ink::line : Ink::fine_dots, exact.empty() ? "" : "steps",
                          exact.empty() ? finite_points(t, x) : thin_out(finite_points(t, x), most_dots)});
  return panel;
}

Panel phase_plane(const std::string& x_label, const std::string& y_label, const std::vector<double>& x,
                  const std::vector<double>& y, const std::vector<double>& exact_x,
                  const std::vector<double>& exact_y) {
  Extent across, up;
  across.include(x);
  across.include(exact_x);
  up.include(y);
  up.include(exact_y);
  Panel panel;
  panel.x = fit_axis(across, padding, {7, 40});
  panel.y = fit_axis(up, padding, {6});
  panel.x_label = x_label;
  panel.y_label = y_label;
  panel.aspect = 0.7;
  if (!exact_x.empty()) {
    panel.series.push_back({Ink::line, "exact", finite_points(exact_x, exact_y), {.colour = exact_colour}});
  }
  panel.series.push_back({Ink::fine_dots, exact_x.empty() ? "" : "steps", thin_out(finite_points(x, y), 2000)});
  return panel;
}

}  // namespace hamflow::reproduction
