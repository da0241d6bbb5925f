#include "hamflow/figures/page.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <span>

#include "draw_style.hpp"
#include "gnuplot.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "legend.hpp"
#include "printed.hpp"
#include "script.hpp"
#include "text.hpp"
#include "whole_file.hpp"

namespace hamflow::figures {

namespace {
// All lengths are in millimetres, for text of 8 and 7 points.
constexpr double edge = 1.5;        // empty border of the page
constexpr double title_line = 3.8;  // distance between lines
constexpr double note_line = 3.4;
constexpr double power_line = 4.2;  // height of a power of ten above a box
constexpr double below_box = 9.0;   // height of a line of tick labels and of the label of the x-axis
constexpr double digit = 1.6;       // width of a character of a tick label
constexpr double colours_gap = 2;   // gap between the box of a map and its colour bar
constexpr double colours_wide = 3;
constexpr double smallest_box = 15;  // smallest side of a box, if the page has a given size
constexpr double label_size = 8;     // points
constexpr double tick_size = 7;
constexpr double tick_line = 2.6;  // line height of tick labels

double letters(std::size_t count) { return digit * static_cast<double>(count); }

class PageWriter {
 public:
  PageWriter(Page page, Format format)
      : page_(std::move(page)),
        script_(format, page_.width),
        title_(wrapped(page_.title, static_cast<std::size_t>(0.615 * page_.width), 3)),
        columns_(page_.columns) {
    if (page_.title.empty()) title_.clear();
    for (const Panel& panel : page_.panels) {
      left_of_box_ = std::max(left_of_box_, edge + 6.2 + letters(panel.y.widest_label()));
      // Words stay below their part of the axis, so they need no room at the right.
      if (panel.x.words.empty()) right_of_box_ = std::max(right_of_box_, 0.8 + 0.5 * letters(panel.x.widest_label()));
      if (panel.is_map()) right_of_box_ = std::max(right_of_box_, colours(panel) + 6.2);
    }
    width_ = cell() - left_of_box_ - right_of_box_;
    for (const Panel& panel : page_.panels) {
      if (are_upright(panel.x)) below_ = std::max(below_, below_box - tick_line + letters(panel.x.widest_label()));
    }
    remove_invisible_points();
    wrap_notes();
    if (page_.height > 0 || width_ < smallest_box) fill_height();
    for (Panel& panel : page_.panels) {
      if (panel.equal_axes) fill_box(panel);
    }
    script_.set_height(page_.height > 0 ? page_.height : full_height());
  }

  std::string write() && {
    set_up();
    title();
    for (std::size_t k = 0; k < page_.panels.size(); ++k) data(k);
    script_.line("set multiplot");
    double top = top_of_panels();
    for (std::size_t k = 0; k < page_.panels.size(); ++k) {
      const std::size_t column = k % columns_;
      panel(k, cell() * static_cast<double>(column) + left_of_box_, top + header_of_row(k - column));
      if (column + 1 == columns_) top += row(k - column);
    }
    if (!page_.legend.empty()) {
      const double left = cell() * static_cast<double>(legend_column()) + left_of_box_;
      draw_legend(script_, page_.legend, left, legend_top(), legend_width());
    }
    script_.line("unset multiplot");
    return std::move(script_).text();
  }

 private:
  /// Returns whether words are wider than their part of the axis, so that they are written upright.
  bool are_upright(const Axis& axis) const {
    return letters(axis.widest_label() + 1) * static_cast<double>(axis.words.size()) > width_ && !axis.words.empty();
  }
  double cell() const { return page_.width / static_cast<double>(columns_); }
  double top_of_panels() const { return edge + title_line * static_cast<double>(title_.size()); }
  double height_of_notes() const {
    return page_.notes.empty() ? 0 : 1 + note_line * static_cast<double>(page_.notes.size());
  }
  /// Removes points that cannot be seen in print. If a path fills an area, a note explains its two shades.
  void remove_invisible_points() {
    constexpr double usual_pixel = 25.4 / 300;  // mm
    bool any_area = false;
    for (Panel& panel : page_.panels) {
      const double height = width_ * panel.aspect;
      const double finest = std::max(width_, height) / 3000;
      const PrintedBox box{width_, height, std::max(finest, std::min(usual_pixel, 25.4 / page_.dpi))};
      std::vector<Series> all;
      for (Series& series : panel.series) {
        std::vector<Series> parts = printed(panel, std::move(series), box);
        any_area = any_area || parts.size() > 1;
        std::move(parts.begin(), parts.end(), std::back_inserter(all));
      }
      panel.series = std::move(all);
    }
    if (any_area) page_.notes.emplace_back("light: the whole line; dark: its first turns");
  }
  /// Breaks notes into lines. Notes begin below the box and end at the border of the page.
  void wrap_notes() {
    constexpr double character = 1.36;  // mm, of text of tick_size
    constexpr std::size_t most_lines = 4;
    const auto room = static_cast<std::size_t>((page_.width - left_of_box_ - edge) / character);
    std::vector<std::string> lines;
    for (const std::string& note : page_.notes) {
      const std::vector<std::string> parts = wrapped_enhanced(note, std::max<std::size_t>(room, 10), most_lines);
      lines.insert(lines.end(), parts.begin(), parts.end());
    }
    page_.notes = std::move(lines);
  }
  std::size_t legend_column() const { return page_.panels.size() % columns_; }
  std::span<const Panel> panels_of_row(std::size_t first) const {
    return std::span(page_.panels).subspan(first, std::min(columns_, page_.panels.size() - first));
  }
  double header_of_row(std::size_t first) const {
    double height = 1.0;
    for (const Panel& panel : panels_of_row(first)) {
      if (panel.y.exponent != 0 || panel.z.exponent != 0) height = std::max(height, power_line);
      const KeyShape key = key_of(panel, width_);
      if (key.rows > 0) height = std::max(height, key_height(key) + 0.9);
    }
    return height;
  }
  double row(std::size_t first) const {
    double aspect = 0;
    for (const Panel& panel : panels_of_row(first)) aspect = std::max(aspect, panel.aspect);
    return header_of_row(first) + width_ * aspect + below_;
  }
  double bottom_of_panels() const {
    double height = top_of_panels();
    for (std::size_t k = 0; k < page_.panels.size(); k += columns_) height += row(k);
    return height;
  }
  /// Width from the legend's left end to the border of the page.
  double legend_width() const {
    return page_.width - cell() * static_cast<double>(legend_column()) - left_of_box_ - edge;
  }
  double legend_top() const {
    const double bottom = bottom_of_panels();
    return legend_column() > 0 ? bottom - row(page_.panels.size() - legend_column()) : bottom;
  }
  double full_height() const {
    double height = bottom_of_panels() + height_of_notes();
    if (!page_.legend.empty())
      height = std::max(height, legend_top() + legend_height(page_.legend, legend_width()) + edge);
    return height;
  }
  /// Width of the colour bar of a map and its tick labels.
  static double colours(const Panel& panel) { return colours_gap + colours_wide + 1 + letters(panel.z.widest_label()); }

  /// Makes all boxes equally high, so that they fill the height of the page.
  void fill_height() {
    double fixed = top_of_panels() + height_of_notes();
    std::size_t rows = 0;
    for (std::size_t k = 0; k < page_.panels.size(); k += columns_, ++rows) fixed += header_of_row(k) + below_;
    const double box = (page_.height - fixed) / static_cast<double>(rows);
    const double needed = fixed + smallest_box * static_cast<double>(rows);
    if (page_.height > 0) {
      for (Panel& panel : page_.panels) panel.aspect = box / width_;
    }
    const bool too_high = page_.height > 0 && (box < smallest_box || full_height() > page_.height + 1e-9);
    if (width_ >= smallest_box && !too_high) return;
    const double least_width = page_.width + static_cast<double>(columns_) * std::max(0.0, smallest_box - width_);
    throw Error(fmt::format("found {:.4g} cm x {} cm; allowed for this figure at least {:.1f} cm x {:.1f} cm",
                            page_.width / 10, page_.height > 0 ? fmt::format("{:.4g}", page_.height / 10) : "any",
                            std::ceil(least_width) / 10,
                            std::ceil(std::max(needed, too_high ? full_height() : needed)) / 10));
  }

  /// Sets one scale for both axes of a box with given shape. The axis with room to spare shows a larger range.
  static void fill_box(Panel& panel) {
    const double x = panel.x.high - panel.x.low;
    const double y = panel.y.high - panel.y.low;
    Axis& wider = y > x * panel.aspect ? panel.x : panel.y;
    const double length = y > x * panel.aspect ? y / panel.aspect : x * panel.aspect;
    const double more = 0.5 * (length - (wider.high - wider.low));
    if (!(more > 1e-9 * length)) return;
    const int exponent = wider.exponent;
    wider = plain_axis(wider.low - more, wider.high + more, {7, 40});
    wider.exponent = exponent;
  }

  void set_up() {
    script_.add(terminal(script_.format(), page_.width, script_.height(), label_size, page_.dpi));
    script_.line("set encoding utf8");
    script_.line("set border 15 linewidth 0.5 linecolor rgb '#333333'");
    script_.line("unset key");
  }

  void title() {
    double y = edge + 0.5 * title_line;
    for (const std::string& text : title_) {
      script_.line("set label {} at screen 0.5,{:.6f} center noenhanced {}", quoted(text), script_.up(y),
                   script_.font(label_size));
      y += title_line;
    }
    y = script_.height() - height_of_notes() - edge + 1 + 0.5 * note_line;
    for (const std::string& note : page_.notes) {
      script_.label(note, left_of_box_, y, "left", tick_size);
      y += note_line;
    }
  }

  void data(std::size_t k) {
    const Panel& panel = page_.panels[k];
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
      script_.line("$data{}_{} << EOD", k, s);
      for (const std::string& text : data_lines(panel, panel.series[s])) script_.line("{}", text);
      script_.line("EOD");
    }
  }

  void panel(std::size_t k, double left, double top) {
    const Panel& panel = page_.panels[k];
    const double right = left + width_;
    const double bottom = top + width_ * panel.aspect;
    const double middle = 0.5 * (top + bottom);
    if (k > 0) script_.line("unset label");
    script_.box(left, right, top, bottom);
    script_.line("set tics {} nomirror scale 0.5", panel.is_map() ? "out" : "in");
    script_.line("{}", panel.has_grid() ? "set grid xtics ytics linewidth 0.3 linecolor rgb '#cccccc'" : "unset grid");
    axis("x", panel.x, are_upright(panel.x) ? "rotate by 90 right" : "norotate center offset 0,0.35");
    axis("y", panel.y, "offset 0,0");
    const double below = bottom + below_ - edge - 1.4;
    script_.label(panel.x_label, 0.5 * (left + right), below, "center", fitting(panel.x_label, right - left));
    script_.label(panel.y_label, left - left_of_box_ + edge + 1.5, middle, "center rotate by 90",
                  fitting(panel.y_label, bottom - top + below_));
    exponent(panel.y, left, top - 2.0, "left");
    exponent(panel.x, right, below, "right");
    if (panel.is_map()) palette(panel);
    if (!panel.note.empty()) script_.label(panel.note, right - 1.5, top + 2.4, "right", tick_size);
    key(panel, right, top);
    plot(k);
    if (panel.is_map()) colour_bar(panel, right, top, bottom);
  }

  /// Returns the size in points with which a label fits.
  static double fitting(const std::string& label, double room) {
    constexpr double character = 1.55;  // mm, of text of label_size
    constexpr double smallest = 5;
    const double needed = character * static_cast<double>(printed_length(label));
    return needed > room ? std::max(smallest, label_size * room / needed) : label_size;
  }

  void exponent(const Axis& axis, double x, double y, const char* how) {
    if (axis.exponent != 0) script_.label("×" + power_of_ten(axis.exponent), x, y, how, tick_size);
  }

  void axis(const char* name, const Axis& axis, const char* offset) {
    script_.line("set {}range [{:.12g}:{:.12g}]", name, axis.low, axis.high);
    const std::string ticks = joined(axis.ticks(), [](const Tick& tick) {
      const bool bare = tick.minor && tick.label.empty();  // gnuplot prints no label for a minor tick
      return fmt::format("{} {:.12g} {}", quoted(tick.label), tick.at, bare ? 1 : 0);
    });
    script_.line("set {}tics ({}) {} {}", name, ticks, script_.font(tick_size), offset);
  }

  void palette(const Panel& panel) {
    // Small values are light: from pale yellow to dark blue, also readable in grey.
    script_.line("set palette defined (0 '#ffffd9', 0.3 '#7fcdbb', 0.6 '#1d91c0', 1 '#081d58')");
    script_.line("set cbrange [{:.12g}:{:.12g}]\nunset colorbox", panel.z.low, panel.z.high);
  }

  /// Draws the colour bar of a map as a plot of its own, because the one of gnuplot shows gaps between its colours.
  void colour_bar(const Panel& panel, double right, double top, double bottom) {
    constexpr int strips = 200;
    const double left = right + colours_gap;
    script_.line("unset label\nunset key\nunset grid\nunset xtics\nunset ytics");
    script_.line("$colours << EOD");
    for (int k = 0; k < strips; ++k) {  // each strip extends upwards below the next ones
      const double low = panel.z.low + (panel.z.high - panel.z.low) * k / strips;
      script_.line("0 {0:.9g} 0 1 {0:.9g} {1:.9g} {2:.9g}", low, panel.z.high,
                   low + 0.5 * (panel.z.high - panel.z.low) / strips);
    }
    script_.line("EOD");
    script_.box(left, left + colours_wide, top, bottom);
    script_.line("set xrange [0:1]\nset yrange [{0:.12g}:{1:.12g}]", panel.z.low, panel.z.high);
    axis("y2", panel.z, "offset -0.7,0");
    exponent(panel.z, left, top - 2.0, "left");
    script_.label(panel.z_label, right + colours(panel) + 2, 0.5 * (top + bottom), "center rotate by 90", label_size);
    script_.line(
        "plot $colours using 1:2:3:4:5:6:7 with boxxyerror fillcolor palette fillstyle solid 1 noborder notitle");
    script_.line("unset y2tics");
  }

  /// Draws the names of the series in the header, ending at `right`, so that they cover no data.
  void key(const Panel& panel, double right, double top) {
    const KeyShape shape = key_of(panel, width_);
    if (shape.rows == 0) {
      script_.line("unset key");
      return;
    }
    draw_key(script_, shape, right, top - 0.7 - key_height(shape));
  }

  void plot(std::size_t k) {
    const Panel& panel = page_.panels[k];
    std::vector<std::string> plots;
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
      if (panel.series[s].curve.x.empty()) continue;
      for (const std::string& how : styles(panel.series[s])) {
        plots.push_back(fmt::format("$data{}_{} using {}", k, s, how));
      }
    }
    script_.line("plot {}", plots.empty() ? "NaN notitle" : joined(plots));
  }

  Page page_;
  Script script_;
  std::vector<std::string> title_;
  std::size_t columns_;
  double left_of_box_ = 0;
  double right_of_box_ = 2.5;
  double below_ = below_box;
  double width_ = 0;  // width of a box
};

}  // namespace

Page Page::with(const PageOptions& options) && {
  if (options.width > 0) width = options.width;
  if (options.height > 0) height = options.height;
  if (options.dpi > 0) dpi = options.dpi;
  if (!options.title) title.clear();
  return std::move(*this);
}

std::string gnuplot_script(const Page& page, Format format) { return PageWriter(page, format).write(); }

void draw(const std::vector<Drawing>& drawings) {
  static std::atomic<bool> font_is_known{false};
  std::vector<std::string> scripts;
  bool needs_font = false;  // for SVG the viewer provides the font
  for (const Drawing& drawing : drawings) {
    for (const std::filesystem::path& file : drawing.files) {
      scripts.push_back(gnuplot_script(drawing.page, format_of(file)));
      needs_font = needs_font || format_of(file) != Format::svg;
    }
  }
  if (scripts.empty()) return;
  const bool probes = needs_font && !font_is_known;
  if (probes) scripts.push_back(font_probe());
  const std::vector<std::string> figures = run_gnuplot(scripts);
  if (probes) require_font(figures.back());
  font_is_known = font_is_known || probes;
  std::size_t next = 0;
  for (const Drawing& drawing : drawings) {
    for (const std::filesystem::path& file : drawing.files) {
      WholeFile whole(file);
      write_whole(whole, finished(figures[next++], format_of(file), drawing.page.title));
    }
  }
}

void draw(const Page& page, const std::filesystem::path& file) { draw({{page, {file}}}); }

}  // namespace hamflow::figures
