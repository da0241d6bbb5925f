#include "parameter_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "draw_style.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/figures/page.hpp"
#include "panels.hpp"
#include "terminal.hpp"
#include "text.hpp"

namespace hamflow {

namespace {
using namespace figures;

/// Makes an axis of values, logarithmic if they are positive and span more than two decades.
Axis value_axis(const std::vector<double>& values, double margin) {
  Extent extent;
  extent.include(values);
  if (extent.low > 0 && extent.high > 100 * extent.low) return log_axis(extent);
  return fit_axis(extent, margin, {7});
}

/// Makes an axis of keys. It is logarithmic for values such as 0.1, 0.05, 0.025, whose distances grow.
Axis key_axis(const ParameterMap& map) {
  if (!map.x_words.empty()) return word_axis(map.x_words);
  Extent extent;
  extent.include(map.x);
  std::vector<double> places = map.x;
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  bool grows = places.size() > 2 && places.front() > 0;
  for (std::size_t k = 2; grows && k < places.size(); ++k) {
    grows = places[k] - places[k - 1] > 1.2 * (places[k - 1] - places[k - 2]);
  }
  return grows || (extent.low > 0 && extent.high > 50 * extent.low && places.size() < 12)
             ? log_axis(extent)
             : fit_axis(extent, 0.03, {7, 40});
}

Panel curves_over(const ParameterMap& map) {
  Panel panel;
  panel.x = key_axis(map);
  std::vector<double> reached = map.value;
  for (std::size_t i = 0; i < map.error.size(); ++i) {
    reached.push_back(map.value[i] - map.error[i]);
    reached.push_back(map.value[i] + map.error[i]);
  }
  panel.y = value_axis(reached, padding);
  panel.y_label = map.value_label;
  panel.aspect = 0.62;
  constexpr int shapes[] = {7, 5, 9, 13, 11, 6, 4, 8};
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < map.x.size(); ++i) {
    const std::string name = map.line.empty() ? "" : map.line[i];
    if (!members.contains(name)) names.push_back(name);
    members[name].push_back(i);
  }
  for (std::size_t n = 0; n < names.size(); ++n) {
    std::vector<std::size_t>& own = members[names[n]];
    std::stable_sort(own.begin(), own.end(), [&](std::size_t a, std::size_t b) { return map.x[a] < map.x[b]; });
    const bool separate = own.size() <= most_separate_dots;
    // A line between words would have no meaning.
    const Ink ink = !map.error.empty()     ? Ink::bars
                    : !map.x_words.empty() ? Ink::marks
                    : separate             ? Ink::marked
                                           : Ink::line;
    Series series{.ink = ink, .name = names[n]};
    series.mark = mark_of(n);
    series.mark.shape = shapes[n % 8];
    for (const std::size_t i : own) series.curve.add(map.x[i], map.value[i]);
    for (const std::size_t i : own) {
      if (!map.error.empty()) series.value.push_back(map.error[i]);
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

/// The different values in order, and the edges of their rectangles, halfway between neighbours.
struct Fields {
  std::vector<double> places;
  std::vector<double> edges;

  explicit Fields(std::vector<double> xs) : places(std::move(xs)) {
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (std::size_t k = 0; k + 1 < places.size(); ++k) edges.push_back(0.5 * (places[k] + places[k + 1]));
    const double alone = places[0] == 0 ? 1 : 0.1 * std::abs(places[0]);
    const double first = edges.empty() ? alone : edges.front() - places.front();
    const double last = edges.empty() ? alone : places.back() - edges.back();
    edges.insert(edges.begin(), places.front() - first);
    edges.push_back(places.back() + last);
  }
  std::size_t at(double x) const {
    return static_cast<std::size_t>(std::lower_bound(places.begin(), places.end(), x) - places.begin());
  }
};

/// Makes a rectangle for each member. Each extends below the rectangles to its right and above it, which are drawn
/// later, because viewers show gaps between rectangles that only touch.
Series fields_of(const ParameterMap& map, const Fields& x, const Fields& y) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  const std::size_t rows = y.places.size();
  std::vector<double> grid(x.places.size() * rows, nothing);
  for (std::size_t i = 0; i < map.x.size(); ++i) grid[x.at(map.x[i]) * rows + y.at(map.y[i])] = map.value[i];
  const auto filled = [&](std::size_t column, std::size_t row) {
    return column < x.places.size() && row < rows && std::isfinite(grid[column * rows + row]);
  };
  Series series{.ink = Ink::fields};
  for (std::size_t column = 0; column < x.places.size(); ++column) {
    for (std::size_t row = 0; row < rows; ++row) {
      if (!filled(column, row)) continue;
      const bool corner = filled(column + 1, row + 1);
      const std::size_t right = filled(column + 1, row) && (corner || !filled(column, row + 1)) ? 2 : 1;
      const std::size_t above = filled(column, row + 1) && (corner || right == 1) ? 2 : 1;
      series.curve.add(x.edges[column], y.edges[row]);
      series.curve.add(x.edges[column + right], y.edges[row + above]);
      series.value.push_back(grid[column * rows + row]);
    }
  }
  return series;
}

Extent extent_of(const Fields& fields) { return {fields.edges.front(), fields.edges.back()}; }

Panel plane_over(const ParameterMap& map) {
  const Fields x(map.x);
  const Fields y(map.y);
  Panel panel;
  panel.x = fit_axis(extent_of(x), 0, {7, 60});
  panel.y = fit_axis(extent_of(y), 0, {7});
  panel.z = value_axis(map.value, 0);
  panel.y_label = map.y_label;
  panel.z_label = map.value_label;
  panel.aspect = 0.8;
  panel.series.push_back(fields_of(map, x, y));
  return panel;
}
}  // namespace

void write_parameter_map(const ParameterMap& map, const std::filesystem::path& file) {
  const std::string refused = refused_figure_file(file);
  if (!refused.empty()) throw Error(refused);
  Extent values;
  values.include(map.value);
  if (values.empty()) throw Error("there is nothing to draw: no member has a finite value of the column");
  Page page{map.title, {map.y.empty() ? curves_over(map) : plane_over(map)}};
  page.panels[0].x_label = map.x_label;
  page.notes = map.notes;
  if (!map.y.empty()) page.width = 120;
  constexpr std::size_t words_of_column = 24;  // upright words that fit next to each other
  if (map.x_words.size() > words_of_column) page.width = two_columns;
  draw(page, file);
}

}  // namespace hamflow
