// How a series becomes lines of a script: its data, and the words of gnuplot for its ink.
#pragma once

#include <string>
#include <vector>

#include "page.hpp"

namespace hamflow::figures {

/// Colours that differ in hue and in grey, the first that of a figure of one run; they repeat after eight.
std::string colour_of(std::size_t place);
/// For the n-th of many series: its colour, and dashes where colours repeat.
Mark mark_of(std::size_t place);

/// The rows of the series, where the panel's axes place them; empty ones lift the pen.
std::vector<std::string> data_lines(const Panel& panel, const Series& series);

/// What stands behind the name of the data in a plot command, once for each layer that is drawn.
std::vector<std::string> styles(const Series& series);

/// The colour of a series, its own or that of its ink.
std::string colour_of(const Series& series);

}  // namespace hamflow::figures
