// Reduces a series to what print can show, so that the size of a figure depends on its pixels and not on the number of
// samples.
#pragma once

#include <vector>

#include "hamflow/figures/page.hpp"

namespace hamflow::figures {

/// Size of the panel's box in print.
struct PrintedBox {
  double width = 0;    // mm
  double height = 0;   // mm
  double pixel = 0.1;  // smallest visible distance in mm
};

/// Returns the same series with fewer points. For a line, each column of pixels keeps its first, lowest, highest and
/// last point, and points on a straight part are removed. Of dots on one pixel, one is kept. A path that runs over
/// itself is drawn once. A path that fills an area becomes two series: the tinted area, and the first turns of the path
/// over it.
std::vector<Series> printed(const Panel& panel, Series series, const PrintedBox& box);

}  // namespace hamflow::figures
