// Planes of space in which paths and positions are drawn.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "figure.hpp"

namespace hamflow::figures {

/// Indices of the horizontal and the vertical axis in a list of names.
using Plane = std::pair<std::size_t, std::size_t>;

/// Returns "x", "y" and, in space, "z".
std::vector<std::string> axes_of_space(std::size_t space);

/// Returns the planes that --x and --y choose; by default all planes of space, or only the first one.
std::vector<Plane> chosen_planes(const FigureOptions& options, const std::vector<std::string>& names, bool first_alone);

}  // namespace hamflow::figures
