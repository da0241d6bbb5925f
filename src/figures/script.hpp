// A script for gnuplot in the making, in millimetres from the upper left corner of the page.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <utility>

#include "hamflow/figures/page.hpp"
#include "terminal.hpp"

namespace hamflow::figures {

class Script {
 public:
  Script(Format format, double width) : format_(format), width_(width) {}

  /// The height of the page, known once its parts are laid out.
  void set_height(double height) { height_ = height; }
  double width() const { return width_; }
  double height() const { return height_; }

  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }
  void add(const std::string& text) { text_ += text; }
  /// Fractions of the page, which is how gnuplot counts "screen", there from the bottom.
  double across(double x) const { return x / width_; }
  double up(double y) const { return 1 - y / height_; }
  std::string font(double points) const { return figures::font(format_, points); }
  Format format() const { return format_; }
  /// Enhanced text; `how` aligns and turns it.
  void label(const std::string& enhanced, double x, double y, const char* how, double points);
  /// The plot that follows fills this rectangle.
  void box(double left, double right, double top, double bottom);

  std::string text() && { return std::move(text_); }

 private:
  Format format_;
  double width_;
  double height_ = 0;
  std::string text_;
};

/// The whole script of a page.   @throws Error where the page has a height, and the panels do not fit into it
std::string gnuplot_script(const Page& page, Format format);

}  // namespace hamflow::figures
