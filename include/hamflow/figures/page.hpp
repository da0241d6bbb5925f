// A figure before it is drawn: panels on a page, measured in millimetres of print, the same for every format. Every
// figure of hamflow is a Page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hamflow/figures/axis.hpp"
#include "hamflow/figures/curves.hpp"

namespace hamflow::figures {

/// How a series is drawn; `marked` is a line through marks, `marks` are those alone, `level` is a dashed line behind
/// the others, `band` the field between two lines, `fields` are coloured rectangles, `bars` marks with their errors.
enum class Ink { exact, dots, fine_dots, line, path, place, zero, centre, marked, marks, level, band, fields, bars };

/// What distinguishes the series of a page.
struct Mark {
  std::string colour{};  // "#rrggbb"; empty: that of the ink
  int shape = 7;         // gnuplot's pointtype: 7 a disc, 6 a ring, 5 and 4 squares, ...
  int dash = 1;          // gnuplot's dashtype: 1 solid
};

struct Series {
  Ink ink = Ink::dots;
  std::string name;  // in the legend above the panel, enhanced text; empty: not listed
  Curve curve;
  Mark mark{};
  /// Of Ink::band the upper line. Of Ink::bars how far a bar reaches up and down. Of Ink::fields a number for each
  /// rectangle, in colours of the panel's axis z; a rectangle is two points of the curve, its lower left and its upper
  /// right corner.
  std::vector<double> value{};
  double opacity = 1;  // of paths and fine dots
};

struct Panel {
  Axis x;
  Axis y;
  Axis z;               // of fields, in colours, from light, little, to dark
  std::string x_label;  // enhanced text, like every label here
  std::string y_label;
  std::string z_label;
  std::string note;  // in the upper right corner, above the data
  std::vector<Series> series;
  double aspect = 0.6;  // height of the box over its width; all boxes of a page are equally wide
  bool equal_axes = false;

  bool is_map() const { return !series.empty() && series.front().ink == Ink::fields; }
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

/// What is asked of a page beside what stands on it.
struct PageOptions {
  double width = 0;  // mm; 0: as wide as is usual
  double height = 0;
  int dpi = 0;  // pixels to the inch of a PNG; 0: 300
  bool title = true;
};

struct Page {
  std::string title;  // plain text
  std::vector<Panel> panels;
  std::size_t columns = 1;           // of panels
  double width = one_column;         // mm
  std::vector<LegendLine> legend{};  // in the cell after the last panel, where it may be longer than a panel
  std::vector<std::string> notes{};  // lines below the panels, enhanced text
  double height = 0;                 // mm; 0: as high as the panels make it
  int dpi = 300;

  /// The same page with another size.
  Page with(const PageOptions& options) &&;
};

/// A page and the files into which it is drawn.
struct Drawing {
  Page page;
  std::vector<std::filesystem::path> files;
};

/// Draws every page into its files in one gnuplot process. The extension of a file chooses SVG, PDF or PNG. A file that
/// exists is replaced once the new one is complete.   @throws Error for another extension, or a page that is too small
/// @throws FileError when gnuplot fails, finds no font, or a file cannot be written
void draw(const std::vector<Drawing>& drawings);
void draw(const Page& page, const std::filesystem::path& file);

}  // namespace hamflow::figures
