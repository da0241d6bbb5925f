// A figure before it is drawn: panels on a page, measured in millimetres of print, the same for every format. Every
// figure of hamflow is a Page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "axis.hpp"
#include "curves.hpp"
#include "terminal.hpp"

namespace hamflow::figures {

/// How a series is drawn; `marked` is a line through marks, `level` a dashed line behind the others, `map` a coloured
/// field.
enum class Ink { exact, dots, fine_dots, line, path, zero, centre, marked, level, map };

/// What distinguishes the marked series of a page.
struct Mark {
  const char* colour = "#000000";
  int shape = 7;  // gnuplot's pointtype: 7 a disc, 6 a ring, 5 and 4 squares, ...
  int dash = 1;   // gnuplot's dashtype: 1 solid
};

struct Series {
  Ink ink = Ink::dots;
  std::string name;  // in the legend of the first panel, enhanced text; empty: not listed
  Curve curve;
  Mark mark{};                  // of Ink::marked
  std::vector<double> value{};  // of Ink::map: one number per point, in colours of the panel's axis z
};

struct Panel {
  Axis x;
  Axis y;
  Axis z;               // of a map, in colours, from light, little, to dark
  std::string x_label;  // enhanced text, like every label here
  std::string y_label;
  std::string z_label;
  std::string note;  // in the upper right corner, above the data
  std::vector<Series> series;
  double aspect = 0.6;  // height of the box over its width; all boxes of a page are equally wide
  bool equal_axes = false;

  bool is_map() const { return !series.empty() && series.front().ink == Ink::map; }
  bool has_grid() const { return x.logarithmic || y.logarithmic; }
};

/// A line of a legend that has a place of its own: a mark and a name, or a heading.
struct LegendLine {
  bool heading = false;
  std::string text;  // enhanced
  Mark mark{};
};

constexpr double one_column = 85;  // mm, of a journal
constexpr double two_columns = 170;

struct Page {
  std::string title;  // plain text
  std::vector<Panel> panels;
  std::size_t columns = 1;           // of panels
  double width = one_column;         // mm
  std::vector<LegendLine> legend{};  // in the cell after the last panel, where it may be longer than a panel
};

std::string gnuplot_script(const Page& page, Format format);

/// Writes svg, pdf or png by the extension of `file`; an existing file is replaced, and only by a complete one.
/// @throws Error when the extension is none of these   @throws FileError when gnuplot, its font or the file fails
void draw(const Page& page, const std::filesystem::path& file);

}  // namespace hamflow::figures
