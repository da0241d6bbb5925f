// Writes a series for a gnuplot script: its data, and the drawing style for its ink.
#pragma once

#include <string>
#include <vector>

#include "hamflow/figures/page.hpp"
#include "hamflow/figures/panel_axes.hpp"

namespace hamflow::figures {

/// Returns the rows of the series, at their positions on the panel's axes; empty rows break a line.
std::vector<std::string> data_lines(const Panel& panel, const Series& series);

/// Returns the text after the name of the data in a plot command, one for each layer.
std::vector<std::string> styles(const Series& series);

}  // namespace hamflow::figures
