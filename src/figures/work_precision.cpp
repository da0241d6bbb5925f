#include "work_precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "axis.hpp"
#include "figure.hpp"
#include "gnuplot.hpp"
#include "hamflow/core/error.hpp"
#include "text.hpp"

namespace hamflow {

namespace {
using namespace figures;

// Millimetres of print: two columns of a journal, three boxes and a cell for the legend.
constexpr double page_wide = 170;
constexpr double left_of_box = 15;
constexpr double right_of_box = 3;
constexpr double box_wide = page_wide / 2 - left_of_box - right_of_box;
constexpr double box_high = 56;
constexpr double below_box = 11;
constexpr double title_line = 4.2;
constexpr double legend_line = 3.7;

double log_of(double x) { return x > 0 ? std::log10(x) : std::numeric_limits<double>::quiet_NaN(); }

/// A logarithmic axis: positions are log10.
struct LogAxis {
  double low = 0;
  double high = 1;

  std::string ticks() const {
    std::string all;
    const auto add = [&](double at, const std::string& label, int level) {
      if (at < low - 1e-9 || at > high + 1e-9) return;
      all += fmt::format("{}{} {:.9g} {}", all.empty() ? "" : ", ", quoted(label), at, level);
    };
    const int step = std::max(1, static_cast<int>(std::ceil((high - low) / 7)));
    const bool narrow = high - low < 2.2;
    for (int k = static_cast<int>(std::floor(low)) - 1; k <= static_cast<int>(std::ceil(high)); ++k) {
      const bool major = ((k % step) + step) % step == 0;
      add(k, major ? power_of_ten(k) : "", major ? 0 : 1);
      for (int digit = 2; digit <= 9 && step == 1; ++digit) {
        const bool labelled = narrow && (digit == 2 || digit == 5);
        add(k + std::log10(digit), labelled ? fmt::format("{}·{}", digit, power_of_ten(k)) : "", 1);
      }
    }
    return all;
  }
};

LogAxis fit(const std::vector<const std::vector<double>*>& all) {
  Extent extent;
  for (const auto* xs : all) {
    for (const double x : *xs) {
      if (x > 0 && std::isfinite(x)) extent.include(std::log10(x));
    }
  }
  if (extent.empty()) return {};
  const double padding = std::max(0.04 * (extent.high - extent.low), 0.1);
  return {extent.low - padding, extent.high + padding};
}

/// A method's mark: a colour for its order; shade, shape and dash for its place among those of its order.
struct Mark {
  const char* colour = "#000000";
  int shape = 7;
  int dash = 1;
};

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

class Script {
 public:
  Script(const WorkPrecision& data, Format format)
      : data_(data), format_(format), entries_(marked(data.curves)), title_(wrapped(data.title, 105, 2)) {
    const double legend_lines = static_cast<double>(legend_rows(legend_columns()));
    const double boxes = 2 * (box_high + below_box);
    const double legend_room = box_high + below_box;
    top_ = 2 + title_line * static_cast<double>(title_.size());
    high_ = top_ + boxes + std::max(0.0, legend_lines * legend_line - legend_room) + 1;
  }

  std::string write() {
    terminal();
    double y = 1.5 + 0.5 * title_line;
    for (const std::string& text : title_) {
      line("set label {} at screen 0.5,{:.6f} center noenhanced {}", quoted(text), up(y), font(9));
      y += title_line;
    }
    for (std::size_t i = 0; i < entries_.size(); ++i) data(i);
    line("set multiplot");
    const std::string error = "error at the end, largest coordinate";
    const std::string work = "evaluations of force or gradient";
    box(0, 0, work, error, 1, 3, &WorkCurve::evaluations, &WorkCurve::error, true);
    box(1, 0, "seconds", error, 2, 3, &WorkCurve::seconds, &WorkCurve::error, true);
    box(0, 1, work, "largest energy error, relative", 1, 4, &WorkCurve::evaluations, &WorkCurve::energy_error, false);
    legend();
    line("unset multiplot");
    return std::move(text_);
  }

 private:
  using Column = std::vector<double> WorkCurve::*;

  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }
  double across(double x) const { return x / page_wide; }
  double up(double y) const { return 1 - y / high_; }
  std::string font(double points) const {
    return fmt::format("font ',{:.4g}'", format_ == Format::svg ? points * 4 / 3 : points);
  }

  void terminal() {
    const double pixel = 25.4 / 96;
    const auto pixels = [&](double mm, int scale) { return static_cast<int>(std::lround(mm / pixel * scale)); };
    if (format_ == Format::svg) {
      line("set terminal svg size {},{} fixed enhanced font 'DejaVu Sans,{:.4g}' linewidth 1.3333 background 'white'",
           pixels(page_wide, 1), pixels(high_, 1), 8 * 4.0 / 3);
    } else if (format_ == Format::pdf) {
      line("set terminal pdfcairo size {:.4f}cm,{:.4f}cm enhanced font 'DejaVu Sans,8' fontscale 0.75 linewidth 2",
           page_wide / 10, high_ / 10);
    } else {
      line("set terminal pngcairo size {},{} enhanced font 'DejaVu Sans,8' fontscale 2 linewidth 2.6667 pointscale 2.6",
           pixels(page_wide, 2), pixels(high_, 2));
    }
    line("set encoding utf8");
    line("set border 15 linewidth 0.5 linecolor rgb '#333333'");
    line("set tics in nomirror scale 0.6,0.3");
    line("set grid xtics ytics linewidth 0.3 linecolor rgb '#cccccc'");
    line("unset key");
  }

  void data(std::size_t i) {
    const WorkCurve& curve = *entries_[i].curve;
    line("$curve{} << EOD", i);
    for (std::size_t k = 0; k < curve.error.size(); ++k) {
      const double row[] = {log_of(curve.evaluations[k]), log_of(curve.seconds[k]), log_of(curve.error[k]),
                            log_of(curve.energy_error[k])};
      for (const double x : row) text_ += std::isfinite(x) ? fmt::format("{:.9g} ", x) : "NaN ";
      text_ += '\n';
    }
    line("EOD");
  }

  LogAxis axis_over(Column column, bool error) const {
    std::vector<const std::vector<double>*> all;
    const std::vector<double> floor{data_.floor};
    for (const WorkCurve& curve : data_.curves) all.push_back(&(curve.*column));
    LogAxis axis = fit(all);
    if (error) axis.high = std::min(axis.high, 2.5);  // beyond, nothing is computed at all
    return axis;
  }

  void box(int column, int row, const std::string& x_label, const std::string& y_label, int x, int y, Column x_column,
           Column y_column, bool with_floor) {
    const double left = page_wide / 2 * column + left_of_box;
    const double top = top_ + (box_high + below_box) * row;
    if (column > 0 || row > 0) line("unset label");  // the title stands with the first box
    line("unset arrow");
    line("set lmargin at screen {:.6f}", across(left));
    line("set rmargin at screen {:.6f}", across(left + box_wide));
    line("set tmargin at screen {:.6f}", up(top));
    line("set bmargin at screen {:.6f}", up(top + box_high));
    const LogAxis horizontal = axis_over(x_column, false);
    const LogAxis vertical = axis_over(y_column, true);
    line("set xrange [{:.9g}:{:.9g}]", horizontal.low, horizontal.high);
    line("set yrange [{:.9g}:{:.9g}]", vertical.low, vertical.high);
    line("set xtics ({}) {} offset 0,0.3", horizontal.ticks(), font(7));
    line("set ytics ({}) {}", vertical.ticks(), font(7));
    label(x_label, left + 0.5 * box_wide, top + box_high + 6.5, "center", 8);
    label(y_label, left - left_of_box + 3, top + 0.5 * box_high, "center rotate by 90", 8);
    const double floor = log_of(data_.floor);
    if (with_floor && floor > vertical.low && floor < vertical.high) {
      line(
          "set arrow from graph 0, first {0:.9g} to graph 1, first {0:.9g} nohead back linewidth 0.6 linecolor rgb "
          "'#aaaaaa' dashtype 2",
          floor);
    }
    std::string command;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      command += fmt::format("{}$curve{} using {}:{} with linespoints {} notitle", i == 0 ? "plot " : ", ", i, x, y,
                             style(entries_[i].mark));
    }
    line("{}", command);
  }

  static std::string style(const Mark& mark) {
    return fmt::format("linecolor rgb '{}' dashtype {} linewidth 0.6 pointtype {} pointsize 0.4", mark.colour,
                       mark.dash, mark.shape);
  }

  void label(const std::string& enhanced, double x, double y, const char* how, double size) {
    line("set label {} at screen {:.6f},{:.6f} {} {}", quoted(enhanced), across(x), up(y), how, font(size));
  }

  std::size_t headings() const {
    std::size_t all = 0;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      all += i == 0 || entries_[i].curve->order != entries_[i - 1].curve->order ? 1 : 0;
    }
    return all;
  }
  std::size_t legend_columns() const { return entries_.size() + headings() > 16 ? 2 : 1; }
  std::size_t legend_rows(std::size_t columns) const {
    return (entries_.size() + headings() + columns - 1) / columns + columns;  // a heading is not left alone
  }

  /// The methods by order in the fourth cell, each with its mark.
  void legend() {
    line("unset label");
    line("unset arrow");
    line("unset border");
    line("unset tics");
    line("unset grid");
    const double left = page_wide / 2 + left_of_box;
    const double top = top_ + box_high + below_box;
    line("set lmargin at screen 0\nset rmargin at screen 1\nset tmargin at screen 1\nset bmargin at screen 0");
    line("set xrange [0:{:.6f}]\nset yrange [{:.6f}:0]", page_wide, high_);
    const std::size_t columns = legend_columns();
    const std::size_t rows = legend_rows(columns);
    std::size_t at = 0;
    std::string command;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const bool heading = i == 0 || entries_[i].curve->order != entries_[i - 1].curve->order;
      if (heading && at % rows == rows - 1) ++at;  // not at the foot of a column
      const auto place = [&] {
        return std::pair(left + box_wide / static_cast<double>(columns) * static_cast<double>(at / rows),
                         top + 2 + legend_line * static_cast<double>(at % rows));
      };
      if (heading) {
        const auto [x, y] = place();
        label(fmt::format("order {}", entries_[i].curve->order), x, y, "left textcolor rgb '#555555'", 7);
        ++at;
      }
      const auto [x, y] = place();
      label(escaped(entries_[i].curve->name), x + 9, y, "left", 7);
      line("$mark{} << EOD\n{:.6f} {:.6f}\n{:.6f} {:.6f}\n{:.6f} {:.6f}\nEOD", i, x, y, x + 3.5, y, x + 7, y);
      command += fmt::format(
          "{}$mark{} using 1:2 with lines linecolor rgb '{}' dashtype {} linewidth 0.6 notitle, "
          "$mark{} every ::1::1 using 1:2 with points linecolor rgb '{}' pointtype {} pointsize 0.5 "
          "linewidth 0.6 notitle",
          command.empty() ? "plot " : ", ", i, entries_[i].mark.colour, entries_[i].mark.dash, i,
          entries_[i].mark.colour, entries_[i].mark.shape);
      ++at;
    }
    line("{}", command);
  }

  const WorkPrecision& data_;
  Format format_;
  std::vector<Entry> entries_;
  std::vector<std::string> title_;
  double top_ = 0;
  double high_ = 0;
  std::string text_;
};

Format format_of(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  return extension == ".pdf" ? Format::pdf : extension == ".png" ? Format::png : Format::svg;
}

bool drawable(const WorkCurve& curve) {
  for (std::size_t k = 0; k < curve.error.size(); ++k) {
    if (std::isfinite(curve.error[k]) && curve.error[k] > 0) return true;
  }
  return false;
}
}  // namespace

std::string refused_figure_file(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".svg" || extension == ".pdf" || extension == ".png") return {};
  return fmt::format("found '{}'; allowed a file .svg, .pdf or .png", file.string());
}

void write_work_precision(const WorkPrecision& data, const std::filesystem::path& file) {
  const std::string refused = refused_figure_file(file);
  if (!refused.empty()) throw Error(refused);
  WorkPrecision shown = data;
  std::erase_if(shown.curves, [](const WorkCurve& curve) { return !drawable(curve); });
  if (shown.curves.empty()) throw Error("there is no error to draw: every run failed, or is exact");
  const Format format = format_of(file);
  if (format != Format::svg) require_font();
  write_whole(file, finished(run_gnuplot(Script(shown, format).write()), format, data.title));
}

}  // namespace hamflow
