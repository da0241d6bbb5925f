// A legend with a place of its own: marks and names below headings, in columns.
#pragma once

#include <cstddef>
#include <vector>

#include "page.hpp"
#include "script.hpp"

namespace hamflow::figures {

/// The height of a legend in millimetres.
double legend_height(const std::vector<LegendLine>& legend);

/// Draws it as a plot of its own that spans the page: the last of a multiplot.
void draw_legend(Script& script, const std::vector<LegendLine>& legend, double left, double top, double width);

}  // namespace hamflow::figures
