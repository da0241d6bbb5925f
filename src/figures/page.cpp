#include "page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "text.hpp"

namespace hamflow::figures {

namespace {
// Millimetres, for text of 8 and 7 points.
constexpr double edge = 1.5;        // free border of the page
constexpr double title_line = 3.8;  // from line to line
constexpr double header = 4.2;      // legend and power of ten, above a box
constexpr double below_box = 9.0;   // tick labels and label of the x-axis
constexpr double digit = 1.6;       // width of a character of a tick label
constexpr double label_size = 8;    // points
constexpr double tick_size = 7;

class ScriptWriter {
 public:
  ScriptWriter(const Page& page, Format format)
      : page_(page), format_(format), title_(wrapped(page.title, 52, 3)), columns_(page.columns) {
    for (const Panel& panel : page.panels) {
      left_of_box_ = std::max(left_of_box_, edge + 6.2 + digit * static_cast<double>(panel.y.widest_label()));
      right_of_box_ = std::max(right_of_box_, 0.8 + 0.5 * digit * static_cast<double>(panel.x.widest_label()));
    }
    width_ = page_width / static_cast<double>(columns_) - left_of_box_ - right_of_box_;
    height_ = edge + title_line * static_cast<double>(title_.size());
    for (std::size_t k = 0; k < page.panels.size(); k += columns_) height_ += row(k);
  }

  std::string write() {
    terminal();
    title();
    for (std::size_t k = 0; k < page_.panels.size(); ++k) data(k);
    line("set multiplot");
    double top = edge + title_line * static_cast<double>(title_.size());
    for (std::size_t k = 0; k < page_.panels.size(); ++k) {
      const std::size_t column = k % columns_;
      const double cell = page_width / static_cast<double>(columns_);
      panel(k, cell * static_cast<double>(column) + left_of_box_, top + header_of_row(k - column));
      if (column + 1 == columns_) top += row(k - column);
    }
    line("unset multiplot");
    return std::move(text_);
  }

 private:
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }
  /// Fractions of the page, which is how gnuplot counts "screen"; y is measured from the top here.
  double across(double x) const { return x / page_width; }
  double up(double y) const { return 1 - y / height_; }
  std::string font(double points) const {
    return fmt::format("font ',{:.4g}'", format_ == Format::svg ? points * 4 / 3 : points);  // SVG counts pixels
  }
  std::span<const Panel> panels_of_row(std::size_t first) const {
    return std::span(page_.panels).subspan(first, std::min(columns_, page_.panels.size() - first));
  }
  double header_of_row(std::size_t first) const {
    for (const Panel& panel : panels_of_row(first)) {
      const bool legend =
          std::any_of(panel.series.begin(), panel.series.end(), [](auto& s) { return !s.name.empty(); });
      if (legend || panel.y.exponent != 0) return header;
    }
    return 1.0;
  }
  double row(std::size_t first) const {
    double aspect = 0;
    for (const Panel& panel : panels_of_row(first)) aspect = std::max(aspect, panel.aspect);
    return header_of_row(first) + width_ * aspect + below_box;
  }

  /// In every format a line width of 1 is one point, a point size of 1 a radius of three points.
  void terminal() {
    const double pixel = 25.4 / 96;
    const auto pixels = [&](double mm, int scale) { return static_cast<int>(std::lround(mm / pixel * scale)); };
    if (format_ == Format::svg) {
      line("set terminal svg size {},{} fixed enhanced font 'DejaVu Sans,{:.4g}' linewidth 1.3333 background 'white'",
           pixels(page_width, 1), pixels(height_, 1), label_size * 4 / 3);
    } else if (format_ == Format::pdf) {
      line("set terminal pdfcairo size {:.4f}cm,{:.4f}cm enhanced font 'DejaVu Sans,{}' fontscale 0.75 linewidth 2",
           page_width / 10, height_ / 10, label_size);
    } else {
      line(
          "set terminal pngcairo size {},{} enhanced font 'DejaVu Sans,{}' fontscale 2 linewidth 2.6667 pointscale 2.6",
          pixels(page_width, 2), pixels(height_, 2), label_size);
    }
    line("set encoding utf8");
    line("set border 15 linewidth 0.5 linecolor rgb '#333333'");
    line("set tics in nomirror scale 0.5");
    line("unset key");
  }

  void title() {
    double y = edge + 0.5 * title_line;
    for (const std::string& text : title_) {
      line("set label {} at screen 0.5,{:.6f} center noenhanced {}", quoted(text), up(y), font(label_size));
      y += title_line;
    }
  }

  void data(std::size_t k) {
    const Panel& panel = page_.panels[k];
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
      const Curve& curve = panel.series[s].curve;
      line("$data{}_{} << EOD", k, s);
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const double x = scaled(curve.x[i], panel.x.exponent);
        const double y = scaled(curve.y[i], panel.y.exponent);
        if (std::isfinite(x) && std::isfinite(y)) {
          line("{:.12g} {:.12g}", x, y);
        } else {
          text_ += '\n';  // an empty line lifts the pen
        }
      }
      line("EOD");
    }
  }

  void panel(std::size_t k, double left, double top) {
    const Panel& panel = page_.panels[k];
    const double right = left + width_;
    const double bottom = top + width_ * panel.aspect;
    if (k > 0) line("unset label");
    line("set lmargin at screen {:.6f}", across(left));
    line("set rmargin at screen {:.6f}", across(right));
    line("set tmargin at screen {:.6f}", up(top));
    line("set bmargin at screen {:.6f}", up(bottom));
    line("set size {}", panel.equal_axes ? "ratio -1" : "noratio");
    axis('x', panel.x, 0.35);
    axis('y', panel.y, 0);
    const double middle = 0.5 * (top + bottom);
    label(panel.x_label, 0.5 * (left + right), bottom + below_box - edge - 1.4, "center", label_size);
    label(panel.y_label, left - left_of_box_ + edge + 1.5, middle, "center rotate by 90", label_size);
    if (panel.y.exponent != 0) {
      label("×" + power_of_ten(panel.y.exponent), left, top - 2.0, "left", tick_size);
    }
    if (panel.x.exponent != 0) {
      label("×" + power_of_ten(panel.x.exponent), right, bottom + below_box - edge - 1.4, "right", tick_size);
    }
    if (!panel.note.empty()) label(panel.note, right - 1.5, top + 2.4, "right", tick_size);
    if (k == 0) legend(right, top - 2.0);
    plot(k);
  }

  void axis(char name, const Axis& axis, double offset) {
    line("set {}range [{:.12g}:{:.12g}]", name, axis.low, axis.high);
    std::string ticks;
    for (const auto& [at, text] : axis.ticks()) {
      ticks += fmt::format("{}{} {:.12g}", ticks.empty() ? "" : ", ", quoted(text), at);
    }
    line("set {}tics ({}) {} offset 0,{}", name, ticks, font(tick_size), offset);
  }

  void label(const std::string& enhanced, double x, double y, const char* how, double size) {
    line("set label {} at screen {:.6f},{:.6f} {} {}", quoted(enhanced), across(x), up(y), how, font(size));
  }

  /// In the header, ending at `right`: it covers no data.
  void legend(double right, double y) {
    line("set key at screen {:.6f},{:.6f} right center horizontal Left reverse samplen 1.2 maxrows 1 {}", across(right),
         up(y), font(tick_size));
  }

  void plot(std::size_t k) {
    const Panel& panel = page_.panels[k];
    std::string command;
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
      const Series& series = panel.series[s];
      if (series.curve.x.empty()) continue;
      command += command.empty() ? "plot " : ", ";
      command += fmt::format("$data{}_{} using 1:2 {} ", k, s, style(series.ink));
      command += series.name.empty() ? "notitle" : "title " + quoted(series.name);
    }
    line("{}", command.empty() ? "plot NaN notitle" : command);
  }

  /// Dark dots over a lighter line: they differ in grey as well.
  static const char* style(Ink ink) {
    switch (ink) {
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
    }
    return "with lines";
  }

  const Page& page_;
  Format format_;
  std::vector<std::string> title_;
  std::size_t columns_;
  double left_of_box_ = 0;
  double right_of_box_ = 2.5;
  double width_ = 0;   // of a box
  double height_ = 0;  // of the page
  std::string text_;
};

}  // namespace

std::string gnuplot_script(const Page& page, Format format) { return ScriptWriter(page, format).write(); }

}  // namespace hamflow::figures
