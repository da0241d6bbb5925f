// Builds a script for gnuplot. Positions are in millimetres from the upper left corner of the page.
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

  /// Sets the height of the page, which is known once its parts are laid out.
  void set_height(double height) { height_ = height; }
  double width() const { return width_; }
  double height() const { return height_; }

  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }
  void add(const std::string& text) { text_ += text; }
  /// Convert positions to fractions of the page, which gnuplot calls "screen" and counts from the bottom.
  double across(double x) const { return x / width_; }
  double up(double y) const { return 1 - y / height_; }
  std::string font(double points) const { return figures::font(format_, points); }
  Format format() const { return format_; }
  /// Writes enhanced text; `how` contains its alignment and rotation.
  void label(const std::string& enhanced, double x, double y, const char* how, double points);
  /// Makes the next plot fill this rectangle.
  void box(double left, double right, double top, double bottom);

  std::string text() && { return std::move(text_); }

 private:
  Format format_;
  double width_;
  double height_ = 0;
  std::string text_;
};

/// Returns the script of a page.   @throws Error if the page has a height into which the panels do not fit
std::string gnuplot_script(const Page& page, Format format);

}  // namespace hamflow::figures
