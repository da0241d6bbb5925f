// What of a series paper can show. A figure holds no more points than its pixels carry, however many samples a run has.
#pragma once

#include <vector>

#include "hamflow/figures/page.hpp"

namespace hamflow::figures {

/// The panel's box in print.
struct PrintedBox {
  double width = 0;    // mm
  double height = 0;   // mm
  double pixel = 0.1;  // mm, the smallest distance that is seen
};

/// The same series with fewer points. Of a line each column of pixels keeps its first, least, largest and last point,
/// and points on a straight part are left out; of dots on one pixel one is drawn. A path that runs over itself is drawn
/// once. One that fills an area becomes two series: the tinted area, and over it the first turns of the path.
std::vector<Series> printed(const Panel& panel, Series series, const PrintedBox& box);

}  // namespace hamflow::figures
