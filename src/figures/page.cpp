#include "page.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "gnuplot.hpp"
#include "hamflow/core/text.hpp"
#include "legend.hpp"
#include "script.hpp"
#include "text.hpp"

namespace hamflow::figures {

namespace {
// Millimetres, for text of 8 and 7 points.
constexpr double edge = 1.5;        // free border of the page
constexpr double title_line = 3.8;  // from line to line
constexpr double header = 4.2;      // legend and power of ten, above a box
constexpr double below_box = 9.0;   // tick labels and label of the x-axis
constexpr double digit = 1.6;       // width of a character of a tick label
constexpr double colours_gap = 2;   // between the box of a map and its colours
constexpr double colours_wide = 3;
constexpr double label_size = 8;  // points
constexpr double tick_size = 7;

double letters(std::size_t count) { return digit * static_cast<double>(count); }

/// Dark dots over a lighter line: they differ in grey as well.
std::string style(const Series& series) {
  switch (series.ink) {
    case Ink::exact:
      return "with lines linewidth 0.6 linecolor rgb '#8c8c8c'";
    case Ink::dots:
      return "with points pointtype 7 pointsize 0.3 linewidth 0.1 linecolor rgb '#1f4e8c'";
    case Ink::fine_dots:
      return "with points pointtype 7 pointsize 0.2 linewidth 0.1 linecolor rgb '#1f4e8c'";
    case Ink::line:
      return "with lines linewidth 0.6 linecolor rgb '#1f4e8c'";
    case Ink::path:
      return "with lines linewidth 0.3 linecolor rgb '#1f4e8c'";
    case Ink::zero:
      return "with lines linewidth 0.4 linecolor rgb '#b0b0b0'";
    case Ink::centre:
      return "with points pointtype 1 pointsize 0.6 linewidth 0.7 linecolor rgb '#333333'";
    case Ink::level:
      return "with lines linewidth 0.6 linecolor rgb '#aaaaaa' dashtype 2";
    case Ink::marked:
      return fmt::format("with linespoints linecolor rgb '{}' dashtype {} linewidth 0.6 pointtype {} pointsize 0.4",
                         series.mark.colour, series.mark.dash, series.mark.shape);
    case Ink::map:
      return "with image pixels";
  }
  return "with lines";
}

class PageWriter {
 public:
  PageWriter(const Page& page, Format format)
      : page_(page),
        script_(format, page.width),
        title_(wrapped(page.title, page.width > one_column ? 105 : 52, 3)),
        columns_(page.columns) {
    for (const Panel& panel : page.panels) {
      left_of_box_ = std::max(left_of_box_, edge + 6.2 + letters(panel.y.widest_label()));
      right_of_box_ = std::max(right_of_box_, 0.8 + 0.5 * letters(panel.x.widest_label()));
      if (panel.is_map()) right_of_box_ = std::max(right_of_box_, colours(panel) + 6.2);
    }
    width_ = cell() - left_of_box_ - right_of_box_;
    const double top = edge + title_line * static_cast<double>(title_.size());
    double height = top;
    for (std::size_t k = 0; k < page.panels.size(); k += columns_) height += row(k);
    if (!page.legend.empty()) {
      legend_top_ = height - (legend_column() > 0 ? row(page.panels.size() - legend_column()) : 0);
      height = std::max(height, legend_top_ + legend_height(page.legend) + edge);
    }
    script_.set_height(height);
  }

  std::string write() && {
    set_up();
    title();
    for (std::size_t k = 0; k < page_.panels.size(); ++k) data(k);
    script_.line("set multiplot");
    double top = edge + title_line * static_cast<double>(title_.size());
    for (std::size_t k = 0; k < page_.panels.size(); ++k) {
      const std::size_t column = k % columns_;
      panel(k, cell() * static_cast<double>(column) + left_of_box_, top + header_of_row(k - column));
      if (column + 1 == columns_) top += row(k - column);
    }
    if (!page_.legend.empty()) {
      const double left = cell() * static_cast<double>(legend_column()) + left_of_box_;
      draw_legend(script_, page_.legend, left, legend_top_, width_);
    }
    script_.line("unset multiplot");
    return std::move(script_).text();
  }

 private:
  double cell() const { return page_.width / static_cast<double>(columns_); }
  std::size_t legend_column() const { return page_.panels.size() % columns_; }
  std::span<const Panel> panels_of_row(std::size_t first) const {
    return std::span(page_.panels).subspan(first, std::min(columns_, page_.panels.size() - first));
  }
  double header_of_row(std::size_t first) const {
    for (const Panel& panel : panels_of_row(first)) {
      const bool legend =
          std::any_of(panel.series.begin(), panel.series.end(), [](auto& s) { return !s.name.empty(); });
      if (legend || panel.y.exponent != 0 || panel.z.exponent != 0) return header;
    }
    return 1.0;
  }
  double row(std::size_t first) const {
    double aspect = 0;
    for (const Panel& panel : panels_of_row(first)) aspect = std::max(aspect, panel.aspect);
    return header_of_row(first) + width_ * aspect + below_box;
  }
  /// The colours of a map and their tick labels.
  static double colours(const Panel& panel) { return colours_gap + colours_wide + 1 + letters(panel.z.widest_label()); }

  void set_up() {
    script_.add(terminal(script_.format(), page_.width, script_.height(), label_size));
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
  }

  void data(std::size_t k) {
    const Panel& panel = page_.panels[k];
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
      const Series& series = panel.series[s];
      script_.line("$data{}_{} << EOD", k, s);
      for (std::size_t i = 0; i < series.curve.x.size(); ++i) {
        const double x = panel.x.place(series.curve.x[i]);
        const double y = panel.y.place(series.curve.y[i]);
        if (!std::isfinite(x) || !std::isfinite(y)) {
          script_.add("\n");  // an empty line lifts the pen
        } else if (series.ink == Ink::map) {
          const double z = panel.z.place(series.value[i]);
          script_.line("{:.12g} {:.12g} {}", x, y, std::isfinite(z) ? fmt::format("{:.12g}", z) : "NaN");
        } else {
          script_.line("{:.12g} {:.12g}", x, y);
        }
      }
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
    script_.line("set size {}", panel.equal_axes ? "ratio -1" : "noratio");
    script_.line("set tics {} nomirror scale 0.5", panel.is_map() ? "out" : "in");
    script_.line("{}", panel.has_grid() ? "set grid xtics ytics linewidth 0.3 linecolor rgb '#cccccc'" : "unset grid");
    axis("x", panel.x, "offset 0,0.35");
    axis("y", panel.y, "offset 0,0");
    const double below = bottom + below_box - edge - 1.4;
    script_.label(panel.x_label, 0.5 * (left + right), below, "center", label_size);
    script_.label(panel.y_label, left - left_of_box_ + edge + 1.5, middle, "center rotate by 90", label_size);
    exponent(panel.y, left, top - 2.0, "left");
    exponent(panel.x, right, below, "right");
    if (panel.is_map()) colour_bar(panel, right, top, bottom);
    if (!panel.note.empty()) script_.label(panel.note, right - 1.5, top + 2.4, "right", tick_size);
    if (k == 0) legend(right, top - 2.0);
    plot(k);
  }

  void exponent(const Axis& axis, double x, double y, const char* how) {
    if (axis.exponent != 0) script_.label("×" + power_of_ten(axis.exponent), x, y, how, tick_size);
  }

  void axis(const char* name, const Axis& axis, const char* offset) {
    script_.line("set {}range [{:.12g}:{:.12g}]", name, axis.low, axis.high);
    const std::string ticks = joined(axis.ticks(), [](const Tick& tick) {
      return fmt::format("{} {:.12g} {}", quoted(tick.label), tick.at, tick.minor ? 1 : 0);
    });
    script_.line("set {}tics ({}) {} {}", name, ticks, script_.font(tick_size), offset);
  }

  void colour_bar(const Panel& panel, double right, double top, double bottom) {
    // Light is little: from pale yellow to dark blue, readable in grey too.
    script_.line("set palette defined (0 '#ffffd9', 0.3 '#7fcdbb', 0.6 '#1d91c0', 1 '#081d58')");
    script_.line("set colorbox vertical user origin screen {:.6f},{:.6f} size screen {:.6f},{:.6f} border",
                 script_.across(right + colours_gap), script_.up(bottom), script_.across(colours_wide),
                 script_.up(top) - script_.up(bottom));
    axis("cb", panel.z, "offset -0.7,0");
    exponent(panel.z, right + colours_gap, top - 2.0, "left");
    script_.label(panel.z_label, right + colours(panel) + 2, 0.5 * (top + bottom), "center rotate by 90", label_size);
  }

  /// In the header, ending at `right`: it covers no data.
  void legend(double right, double y) {
    script_.line("set key at screen {:.6f},{:.6f} right center horizontal Left reverse samplen 1.2 maxrows 1 {}",
                 script_.across(right), script_.up(y), script_.font(tick_size));
  }

  void plot(std::size_t k) {
    const Panel& panel = page_.panels[k];
    std::vector<std::string> plots;
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
      const Series& series = panel.series[s];
      if (series.curve.x.empty()) continue;
      plots.push_back(fmt::format("$data{}_{} using {} {} {}", k, s, series.ink == Ink::map ? "1:2:3" : "1:2",
                                  style(series), series.name.empty() ? "notitle" : "title " + quoted(series.name)));
    }
    script_.line("plot {}", plots.empty() ? "NaN notitle" : joined(plots));
  }

  const Page& page_;
  Script script_;
  std::vector<std::string> title_;
  std::size_t columns_;
  double left_of_box_ = 0;
  double right_of_box_ = 2.5;
  double width_ = 0;  // of a box
  double legend_top_ = 0;
};

}  // namespace

std::string gnuplot_script(const Page& page, Format format) { return PageWriter(page, format).write(); }

void draw(const Page& page, const std::filesystem::path& file) {
  const Format format = format_of(file);
  if (format != Format::svg) require_font();
  write_whole(file, finished(run_gnuplot(gnuplot_script(page, format)), format, page.title));
}

}  // namespace hamflow::figures
