#include "legend.hpp"

#include <algorithm>

#include "hamflow/core/text.hpp"
#include "text.hpp"

namespace hamflow::figures {

namespace {
constexpr double line_height = 3.7;  // mm
constexpr double key_line = 3.3;
constexpr double text_points = 7;
constexpr std::size_t most_in_one_column = 16;

constexpr double letter = 1.42;  // width of a letter of 7 points in mm
constexpr double mark_width = 9;

/// Positions of the lines of a legend, in columns as wide as their names.
struct Layout {
  struct Place {
    double x = 0;
    std::size_t row = 0;
  };
  std::vector<Place> places;
  std::size_t rows = 0;
  double width = 0;
};

Layout layout_of(const std::vector<LegendLine>& legend, std::size_t columns) {
  const std::size_t rows = (legend.size() + columns - 1) / columns + columns - 1;
  Layout layout;
  double left = 0;
  std::size_t row = 0;
  for (std::size_t i = 0; i < legend.size(); ++i) {
    // a heading must not be the last line of a column
    const bool is_full = row == rows || (legend[i].heading && row + 1 == rows);
    if (is_full && i > 0) {
      left = layout.width + 2;
      row = 0;
    }
    layout.places.push_back({left, row++});
    layout.rows = std::max(layout.rows, row);
    const double name = letter * static_cast<double>(printed_length(legend[i].text));
    layout.width = std::max(layout.width, left + name + (legend[i].heading ? 0 : mark_width));
  }
  return layout;
}

/// Lays out a long legend in two columns, if the width allows.
Layout layout_in(const std::vector<LegendLine>& legend, double width) {
  if (legend.size() <= most_in_one_column) return layout_of(legend, 1);
  const Layout two = layout_of(legend, 2);
  return two.width <= width ? two : layout_of(legend, 1);
}
}  // namespace

KeyShape key_of(const Panel& panel, double width) {
  std::size_t names = 0;
  std::size_t longest = 0;
  for (const Series& series : panel.series) {
    if (series.name.empty() || series.curve.x.empty()) continue;
    ++names;
    longest = std::max(longest, printed_length(series.name));
  }
  if (names == 0) return {};
  const double entry = 8.5 + letter * static_cast<double>(longest);
  const double room = width - (panel.y.exponent != 0 || panel.z.exponent != 0 ? 9 : 0);
  KeyShape shape;
  shape.columns = std::clamp<std::size_t>(static_cast<std::size_t>(std::max(room, 0.0) / entry), 1, names);
  shape.rows = (names + shape.columns - 1) / shape.columns;
  shape.columns = (names + shape.rows - 1) / shape.rows;
  return shape;
}

double key_height(const KeyShape& shape) { return key_line * static_cast<double>(shape.rows); }

void draw_key(Script& script, const KeyShape& shape, double right, double top) {
  script.line("set key at screen {:.6f},{:.6f} right top horizontal Left reverse samplen 1.2 maxcols {} maxrows {} {}",
              script.across(right), script.up(top), shape.columns, shape.rows, script.font(text_points));
}

double legend_height(const std::vector<LegendLine>& legend, double width) {
  return line_height * static_cast<double>(layout_in(legend, width).rows + 1);
}

void draw_legend(Script& script, const std::vector<LegendLine>& legend, double left, double top, double width) {
  script.line("unset label\nunset border\nunset tics\nunset grid\nset size noratio");
  script.box(0, script.width(), 0, script.height());
  script.line("set xrange [0:{:.6f}]\nset yrange [{:.6f}:0]", script.width(), script.height());
  const Layout layout = layout_in(legend, width);
  std::vector<std::string> plots;
  for (std::size_t i = 0; i < legend.size(); ++i) {
    const LegendLine& entry = legend[i];
    const double x = left + layout.places[i].x;
    const double y = top + 2 + line_height * static_cast<double>(layout.places[i].row);
    if (entry.heading) {
      script.label(entry.text, x, y, "left textcolor rgb '#555555'", text_points);
      continue;
    }
    script.label(entry.text, x + mark_width, y, "left", text_points);
    script.line("$mark{} << EOD\n{:.6f} {:.6f}\n{:.6f} {:.6f}\n{:.6f} {:.6f}\nEOD", i, x, y, x + 3.5, y, x + 7, y);
    plots.push_back(fmt::format("$mark{} using 1:2 with lines linecolor rgb '{}' dashtype {} linewidth 0.6 notitle", i,
                                entry.mark.colour, entry.mark.dash));
    plots.push_back(fmt::format(
        "$mark{} every ::1::1 using 1:2 with points linecolor rgb '{}' pointtype {} pointsize 0.5 linewidth "
        "0.6 notitle",
        i, entry.mark.colour, entry.mark.shape));
  }
  script.line("plot {}", joined(plots));
}

}  // namespace hamflow::figures
