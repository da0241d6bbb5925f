#include "work_precision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hamflow/core/error.hpp"
#include "hamflow/figures/page.hpp"
#include "terminal.hpp"
#include "text.hpp"

namespace hamflow {

namespace {
using namespace figures;
using Column = std::vector<double> WorkCurve::*;

/// A method with its mark. No two methods have the same colour and shape.
struct Entry {
  const WorkCurve* curve = nullptr;
  Mark mark;
};

/// Methods whose order varies come last.
int rank(const WorkCurve& curve) { return curve.order > 0 ? curve.order : std::numeric_limits<int>::max(); }

/// Sorts methods by order and gives them marks. Successive colours differ clearly. Shapes are filled for explicit
/// methods and open for implicit ones, whose lines are dashed, so that the difference is also visible in grey.
std::vector<Entry> marked(const std::vector<WorkCurve>& curves) {
  constexpr std::array<const char*, 11> colours{"#0072b2", "#d55e00", "#009e73", "#b0489c", "#e69f00", "#56b4e9",
                                                "#7b5b1e", "#4d4d4d", "#8a2f00", "#7a5cc0", "#6b8e23"};
  constexpr std::array<int, 5> filled{7, 5, 9, 13, 11};
  constexpr std::array<int, 5> open{6, 4, 8, 12, 10};
  std::vector<const WorkCurve*> sorted;
  for (const WorkCurve& curve : curves) sorted.push_back(&curve);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const WorkCurve* a, const WorkCurve* b) { return rank(*a) < rank(*b); });
  std::vector<Entry> all;
  for (std::size_t n = 0; n < sorted.size(); ++n) {
    const bool is_explicit = sorted[n]->explicit_step;
    // 11 colours and 5 shapes have no common factor, so pairs repeat only after 55 methods.
    all.push_back({sorted[n], {colours[n % 11], (is_explicit ? filled : open)[n % 5], is_explicit ? 1 : 2}});
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

/// Visits each error of a curve that a logarithmic axis can show.
template <class Use>
void for_each_error(const WorkCurve& curve, Column column, const Use& use) {
  for (const double x : curve.*column) {
    if (std::isfinite(x) && x > 0) use(x);
  }
}

/// Returns the upper end of the axis. Errors more than some hundred times the size of the motion are cut off. But the
/// smallest error of each method is shown, unless it is so large that the other errors would become unreadable.
double top_of_errors(const std::vector<Entry>& entries, Column column, double size) {
  constexpr double hundreds = 2.5;
  constexpr double farthest = 16;
  const double motion = std::log10(size);
  double top = motion + hundreds;
  for (const Entry& entry : entries) {
    double least = std::numeric_limits<double>::infinity();
    for_each_error(*entry.curve, column, [&](double x) { least = std::min(least, std::log10(x)); });
    if (least < motion + farthest) top = std::max(top, least + 0.1);
  }
  return top;
}

Panel panel_of(const std::vector<Entry>& entries, const Quantity& work, const Quantity& error, double size) {
  Panel panel;
  panel.x = axis_over(entries, work.column);
  panel.y = axis_over(entries, error.column);
  panel.y.high = std::min(panel.y.high, std::max(top_of_errors(entries, error.column, size), panel.y.low + 1));
  panel.x_label = work.label;
  panel.y_label = error.label;
  panel.aspect = 0.84;
  for (const Entry& entry : entries) {
    panel.series.push_back({Ink::marked, "", {entry.curve->*work.column, entry.curve->*error.column}, entry.mark});
  }
  return panel;
}

/// Draws the level below which errors mean nothing. @returns whether the panel shows it
bool add_floor(Panel& panel, double floor) {
  if (!(floor > 0)) return false;
  const double level = panel.y.place(floor);
  if (level <= panel.y.low || level >= panel.y.high) return false;
  const Curve line{{std::pow(10.0, panel.x.low), std::pow(10.0, panel.x.high)}, {floor, floor}};
  panel.series.insert(panel.series.begin(), {Ink::level, "", line});
  return true;
}

/// Lists the methods by order, each with its mark.
std::vector<LegendLine> legend_of(const std::vector<Entry>& entries) {
  std::vector<LegendLine> legend;
  int order = -1;
  for (const Entry& entry : entries) {
    if (entry.curve->order != order) {
      legend.push_back(
          {true, entry.curve->order > 0 ? "order " + std::to_string(entry.curve->order) : "order by tolerance"});
    }
    order = entry.curve->order;
    legend.push_back({false, escaped(entry.curve->name), entry.mark});
  }
  return legend;
}

bool drawable(const WorkCurve& curve) {
  return std::any_of(curve.error.begin(), curve.error.end(), [](double x) { return std::isfinite(x) && x > 0; });
}

/// Adds a note such as "failed: rk4 2 of 6" for the methods with such numbers; none if there are no such methods.
template <class Is>
void note_numbers(Page& page, const std::string& kind, const std::vector<WorkCurve>& curves, Column column,
                  const Is& is) {
  constexpr std::size_t width = 110;  // in characters
  std::string all;
  for (const WorkCurve& curve : curves) {
    const std::vector<double>& numbers = curve.*column;
    const auto count = std::count_if(numbers.begin(), numbers.end(), is);
    if (count == 0) continue;
    all +=
        (all.empty() ? "" : ", ") + curve.name + " " + std::to_string(count) + " of " + std::to_string(numbers.size());
  }
  if (all.empty()) return;
  for (const std::string& line : wrapped(kind + ": " + all, width, 3)) page.notes.push_back(escaped(line));
}

/// Adds notes on what the panels leave out.
void note_what_is_missing(Page& page, const WorkPrecision& data) {
  const auto beyond = [](const Panel& panel) {
    return [top = panel.y.high](double x) { return std::isfinite(x) && x > 0 && std::log10(x) > top; };
  };
  note_numbers(page, "failed", data.curves, &WorkCurve::error, [](double x) { return !std::isfinite(x); });
  note_numbers(page, "without error", data.curves, &WorkCurve::error, [](double x) { return x == 0; });
  note_numbers(page, "errors above the axis", data.curves, &WorkCurve::error, beyond(page.panels.front()));
  note_numbers(page, "errors of energy above the axis", data.curves, &WorkCurve::energy_error,
               beyond(page.panels.back()));
}
}  // namespace

figures::Page work_precision_page(const WorkPrecision& data) {
  std::vector<WorkCurve> curves = data.curves;
  std::erase_if(curves, [](const WorkCurve& curve) { return !drawable(curve); });
  if (curves.empty()) throw Error("there is no error to draw: every run failed, or is exact");
  const std::vector<Entry> entries = marked(curves);
  const Quantity evaluations{"evaluations of force or gradient", &WorkCurve::evaluations};
  const Quantity seconds{"processor time in seconds", &WorkCurve::seconds};
  const Quantity error{"largest relative error of q, p at the end", &WorkCurve::error};
  const Quantity energy_error{"max |{/:Italic H} − {/:Italic H}_0|/scale", &WorkCurve::energy_error};
  Page page{data.title, {}, 2, two_columns, legend_of(entries)};
  bool floor_shown = false;
  for (const Quantity& work : {evaluations, seconds}) {
    page.panels.push_back(panel_of(entries, work, error, data.size));
    floor_shown = add_floor(page.panels.back(), data.floor) || floor_shown;
  }
  page.panels.push_back(panel_of(entries, evaluations, energy_error, 1));
  if (floor_shown) page.notes.push_back("dashed grey: uncertainty of the reference, " + short_number(data.floor));
  note_what_is_missing(page, data);
  return page;
}

void write_work_precision(const WorkPrecision& data, const std::filesystem::path& file) {
  const std::string refused = refused_figure_file(file);
  if (!refused.empty()) throw Error(refused);
  draw(work_precision_page(data), file);
}

}  // namespace hamflow
