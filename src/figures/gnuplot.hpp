// The gnuplot process: scripts go in, the bytes of their figures come out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hamflow/figures/while_drawing.hpp"
#include "terminal.hpp"

namespace hamflow::figures {

/// Runs scripts, whose first lines choose the terminals, in one process and returns the figures that it writes, one of
/// each.   @param longest seconds for each of them, after which gnuplot is ended
/// @throws FileError with gnuplot's own words, or when it takes longer   @throws DrawingStopped
std::vector<std::string> run_gnuplot(const std::vector<std::string>& scripts, double longest = 300);

/// The same figure without what changes from run to run or names the program: dates, and tooltips saying "Gnuplot".
/// @throws FileError when the bytes are not a figure of that format
std::string finished(std::string bytes, Format format, const std::string& title);

/// A script that shows whether gnuplot finds a font: without one it draws blanks, and says nothing.
std::string font_probe();
/// @param probed what font_probe() drew   @throws FileError naming the package to install
void require_font(const std::string& probed);

}  // namespace hamflow::figures
