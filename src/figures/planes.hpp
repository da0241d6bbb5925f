// In which planes of space paths and places are drawn.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "figure.hpp"

namespace hamflow::figures {

/// The axes to the right and upwards, among the names of columns.
using Plane = std::pair<std::size_t, std::size_t>;

/// "x", "y" and, in space, "z".
std::vector<std::string> axes_of_space(std::size_t space);

/// Those that --x and --y ask for; else all of space, or the first alone.
std::vector<Plane> chosen_planes(const FigureOptions& options, const std::vector<std::string>& names, bool first_alone);

}  // namespace hamflow::figures
