// A figure before it is drawn: panels on a page, measured in millimetres of print, the same for every format.
#pragma once

#include <string>
#include <vector>

#include "axis.hpp"
#include "curves.hpp"
#include "gnuplot.hpp"

namespace hamflow::figures {

enum class Ink { exact, dots, fine_dots, line, path, zero, centre };

struct Series {
  Ink ink = Ink::dots;
  std::string name;  // in the legend, enhanced text; empty: not listed
  Curve curve;
};

struct Panel {
  Axis x;
  Axis y;
  std::string x_label;  // enhanced text, like every label here
  std::string y_label;
  std::string note;  // in the upper right corner, above the data
  std::vector<Series> series;
  double aspect = 0.6;  // height of the box over its width; all boxes of a page are equally wide
  bool equal_axes = false;
};

struct Page {
  std::string title;  // plain text
  std::vector<Panel> panels;
  std::size_t columns = 1;
};

constexpr double page_width = 85;  // mm: one column of a journal

std::string gnuplot_script(const Page& page, Format format);

}  // namespace hamflow::figures
