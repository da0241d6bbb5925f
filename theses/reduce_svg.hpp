// Makes figures of the page smaller, without a visible change.
#pragma once

#include <string>

namespace hamflow::reproduction {

/// Reduces an SVG of gnuplot. It removes points of a line that are within 0.05 units of the remaining line, draws dots
/// as one path instead of an element each, draws dots at the same place once, and removes unused symbols. It does not
/// change elements of any other form.
std::string reduce_svg(const std::string& svg);

}  // namespace hamflow::reproduction
