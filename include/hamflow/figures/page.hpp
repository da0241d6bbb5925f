// A figure before it is drawn: panels on a page, measured in millimetres of print, the same for every format. Every
// figure of hamflow is a Page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hamflow/figures/axis.hpp"
#include "hamflow/figures/curves.hpp"

namespace hamflow::figures {

/// How a series is drawn. `marked` is a line with marks, `marks` are marks alone, `level` is a dashed line behind the
/// others, `band` is the area between two lines, `fields` are coloured rectangles, `bars` are marks with error bars.
enum class Ink { exact, dots, fine_dots, line, path, place, zero, centre, marked, marks, level, band, fields, bars };

/// Appearance that distinguishes the series of a page.
struct Mark {
  std::string colour{};  // "#rrggbb"; empty: the colour of the ink
  int shape = 7;         // gnuplot's pointtype: 7 a disc, 6 a ring, 5 and 4 squares, ...
  int dash = 1;          // gnuplot's dashtype: 1 solid
};

struct Series {
  Ink ink = Ink::dots;
  std::string name;  // name in the legend above the panel, enhanced text; empty: not listed
  Curve curve;
  Mark mark{};
  /// For Ink::band: the upper line. For Ink::bars: how far a bar extends up and down. For Ink::fields: a number for
  /// each rectangle, coloured by the panel's axis z; two points of the curve are its lower left and its upper right
  /// corner.
  std::vector<double> value{};
  double opacity = 1;  // for paths and fine dots
};

struct Panel {
  Axis x;
  Axis y;
  Axis z;               // axis for the colours of fields, from light (small) to dark
  std::string x_label;  // enhanced text, like every label here
  std::string y_label;
  std::string z_label;
  std::string note;  // text in the upper right corner, above the data
  std::vector<Series> series;
  double aspect = 0.6;  // height of the box divided by its width; all boxes of a page have the same width
  bool equal_axes = false;

  bool is_map() const { return !series.empty() && series.front().ink == Ink::fields; }
  bool has_grid() const { return x.logarithmic || y.logarithmic; }
};

/// A line of a legend that is placed outside the panels: a mark and a name, or a heading.
struct LegendLine {
  bool heading = false;
  std::string text;  // enhanced text
  Mark mark{};
};

constexpr double one_column = 85;  // width of a journal's column in mm
constexpr double two_columns = 170;

/// Options of a page, apart from its contents.
struct PageOptions {
  double width = 0;  // mm; 0: the usual width
  double height = 0;
  int dpi = 0;  // pixels per inch of a PNG; 0: 300
  bool title = true;
};

struct Page {
  std::string title;  // plain text
  std::vector<Panel> panels;
  std::size_t columns = 1;           // number of panels in a row
  double width = one_column;         // mm
  std::vector<LegendLine> legend{};  // drawn in the cell after the last panel; it may be longer than a panel
  std::vector<std::string> notes{};  // lines below the panels, enhanced text
  double height = 0;                 // mm; 0: determined by the panels
  int dpi = 300;

  /// Returns the same page with other options.
  Page with(const PageOptions& options) &&;
};

/// A page and the files into which it is drawn.
struct Drawing {
  Page page;
  std::vector<std::filesystem::path> files;
};

/// Draws every page into its files in one gnuplot process. The extension of a file determines SVG, PDF or PNG. An
/// existing file is replaced once the new one is complete.   @throws Error for another extension, or a page that is too
/// small
/// @throws FileError if gnuplot fails or finds no font, or if a file cannot be written
void draw(const std::vector<Drawing>& drawings);
void draw(const Page& page, const std::filesystem::path& file);

}  // namespace hamflow::figures
