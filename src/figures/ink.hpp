// How a series becomes lines of a script: its data, and the words of gnuplot for its ink.
#pragma once

#include <string>
#include <vector>

#include "hamflow/figures/page.hpp"
#include "hamflow/figures/panel_axes.hpp"

namespace hamflow::figures {

/// The rows of the series, where the panel's axes place them; empty ones lift the pen.
std::vector<std::string> data_lines(const Panel& panel, const Series& series);

/// What stands behind the name of the data in a plot command, once for each layer that is drawn.
std::vector<std::string> styles(const Series& series);

}  // namespace hamflow::figures
