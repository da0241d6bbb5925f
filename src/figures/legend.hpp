// Legends: the names of a panel's series in rows above it, and, with a place of its own, marks and names below
// headings, in columns.
#pragma once

#include <cstddef>
#include <vector>

#include "hamflow/figures/page.hpp"
#include "script.hpp"

namespace hamflow::figures {

/// The names above a panel.
struct KeyShape {
  std::size_t columns = 0;
  std::size_t rows = 0;  // 0: there are none
};
KeyShape key_of(const Panel& panel, double width);
double key_height(const KeyShape& shape);
/// Its right upper corner is given.
void draw_key(Script& script, const KeyShape& shape, double right, double top);

/// The height of a legend in millimetres.
double legend_height(const std::vector<LegendLine>& legend, double width);

/// Draws it as a plot of its own that spans the page: the last of a multiplot.
void draw_legend(Script& script, const std::vector<LegendLine>& legend, double left, double top, double width);

}  // namespace hamflow::figures
