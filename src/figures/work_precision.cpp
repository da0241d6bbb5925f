#include "work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "hamflow/core/error.hpp"
#include "page.hpp"
#include "text.hpp"

namespace hamflow {

namespace {
using namespace figures;
using Column = std::vector<double> WorkCurve::*;

/// Three shades for each order, next to each other in the legend.
const char* colour_of(int order, int shade) {
  static constexpr const char* grey[] = {"#8c8c8c", "#555555", "#b5b5b5"};
  static constexpr const char* blue[] = {"#0072b2", "#56b4e9", "#003f70"};
  static constexpr const char* violet[] = {"#7a5cc0", "#b39ddb", "#43308a"};
  static constexpr const char* red[] = {"#d55e00", "#f0a35e", "#8a2f00"};
  static constexpr const char* green[] = {"#009e73", "#6cc9a9", "#00573f"};
  static constexpr const char* pink[] = {"#b0489c", "#dd94ce", "#6b1a5c"};
  static constexpr const char* brown[] = {"#7b5b1e", "#c9a227", "#3f2d0c"};
  switch (order) {
    case 1:
      return grey[shade];
    case 2:
      return blue[shade];
    case 3:
      return violet[shade];
    case 4:
      return red[shade];
    case 5:
    case 6:
      return green[shade];
    case 7:
    case 8:
      return pink[shade];
    default:
      return brown[shade];
  }
}

/// A colour for the order of a method; shade, shape and dash for its place among those of its order.
struct Entry {
  const WorkCurve* curve = nullptr;
  Mark mark;
};

/// By order; what does not distinguish two methods by shape does so by dash.
std::vector<Entry> marked(const std::vector<WorkCurve>& curves) {
  constexpr int shapes[] = {7, 5, 9, 13, 11,
                            6, 4, 8, 12, 10};  // filled ones first; implicit methods begin with open ones
  std::vector<const WorkCurve*> sorted;
  for (const WorkCurve& curve : curves) sorted.push_back(&curve);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const WorkCurve* a, const WorkCurve* b) { return a->order < b->order; });
  std::map<int, int> of_order;
  std::vector<Entry> all;
  for (const WorkCurve* curve : sorted) {
    const int place = of_order[curve->order]++;
    const int shape = shapes[(place + (curve->explicit_step ? 0 : 5)) % 10];
    all.push_back({curve, {colour_of(curve->order, place % 3), shape, curve->explicit_step ? 1 : 2}});
    if (place >= 5) all.back().mark.dash = 3 + (place / 5) % 3;
  }
  return all;
}

Axis axis_over(const std::vector<Entry>& entries, Column column) {
  Extent extent;
  for (const Entry& entry : entries) extent.include_positive(entry.curve->*column);
  return log_axis(extent);
}

struct Quantity {
  const char* label;
  Column column;
};

Panel panel_of(const std::vector<Entry>& entries, const Quantity& work, const Quantity& error) {
  Panel panel;
  panel.x = axis_over(entries, work.column);
  panel.y = axis_over(entries, error.column);
  panel.y.high = std::min(panel.y.high, 2.5);  // beyond, nothing is computed at all
  panel.x_label = work.label;
  panel.y_label = error.label;
  panel.aspect = 0.84;
  for (const Entry& entry : entries) {
    panel.series.push_back({Ink::marked, "", {entry.curve->*work.column, entry.curve->*error.column}, entry.mark});
  }
  return panel;
}

/// Errors below it mean nothing.
void add_floor(Panel& panel, double floor) {
  if (!(floor > 0)) return;
  const double level = panel.y.place(floor);
  if (level <= panel.y.low || level >= panel.y.high) return;
  const Curve line{{std::pow(10.0, panel.x.low), std::pow(10.0, panel.x.high)}, {floor, floor}};
  panel.series.insert(panel.series.begin(), {Ink::level, "", line});
}

/// The methods by order, each with its mark.
std::vector<LegendLine> legend_of(const std::vector<Entry>& entries) {
  std::vector<LegendLine> legend;
  int order = -1;
  for (const Entry& entry : entries) {
    if (entry.curve->order != order) legend.push_back({true, "order " + std::to_string(entry.curve->order)});
    order = entry.curve->order;
    legend.push_back({false, escaped(entry.curve->name), entry.mark});
  }
  return legend;
}

bool drawable(const WorkCurve& curve) {
  return std::any_of(curve.error.begin(), curve.error.end(), [](double x) { return std::isfinite(x) && x > 0; });
}
}  // namespace

void write_work_precision(const WorkPrecision& data, const std::filesystem::path& file) {
  const std::string refused = refused_figure_file(file);
  if (!refused.empty()) throw Error(refused);
  std::vector<WorkCurve> curves = data.curves;
  std::erase_if(curves, [](const WorkCurve& curve) { return !drawable(curve); });
  if (curves.empty()) throw Error("there is no error to draw: every run failed, or is exact");
  const std::vector<Entry> entries = marked(curves);
  const Quantity evaluations{"evaluations of force or gradient", &WorkCurve::evaluations};
  const Quantity seconds{"seconds", &WorkCurve::seconds};
  const Quantity error{"error at the end, largest coordinate", &WorkCurve::error};
  const Quantity energy_error{"largest energy error, relative", &WorkCurve::energy_error};
  Page page{data.title, {}, 2, two_columns, legend_of(entries)};
  for (const Quantity& work : {evaluations, seconds}) {
    page.panels.push_back(panel_of(entries, work, error));
    add_floor(page.panels.back(), data.floor);
  }
  page.panels.push_back(panel_of(entries, evaluations, energy_error));
  draw(page, file);
}

}  // namespace hamflow
