// Legends. A key lists the names of a panel's series in rows above it. A legend outside the panels has marks and names
// below headings, in columns.
#pragma once

#include <cstddef>
#include <vector>

#include "hamflow/figures/page.hpp"
#include "script.hpp"

namespace hamflow::figures {

/// Numbers of columns and rows of the names above a panel.
struct KeyShape {
  std::size_t columns = 0;
  std::size_t rows = 0;  // 0: there are no names
};
KeyShape key_of(const Panel& panel, double width);
double key_height(const KeyShape& shape);
/// @param right, top the upper right corner
void draw_key(Script& script, const KeyShape& shape, double right, double top);

/// Returns the height of a legend in millimetres.
double legend_height(const std::vector<LegendLine>& legend, double width);

/// Draws the legend as a plot of its own that spans the page, the last one of a multiplot.
void draw_legend(Script& script, const std::vector<LegendLine>& legend, double left, double top, double width);

}  // namespace hamflow::figures
