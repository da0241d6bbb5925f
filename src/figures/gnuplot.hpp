// Runs gnuplot: scripts are its input, the bytes of their figures its output.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hamflow/figures/stop_drawing.hpp"
#include "terminal.hpp"

namespace hamflow::figures {

/// Runs scripts in one process. Their first lines choose the terminals. Returns one figure for each script.   @param
/// longest time limit for each script in seconds, after which gnuplot is ended
/// @throws FileError with gnuplot's message, or if it takes longer   @throws DrawingStopped
std::vector<std::string> run_gnuplot(const std::vector<std::string>& scripts, double longest = 300);

/// Removes from a figure what changes from run to run or names the program: dates, and tooltips with "Gnuplot".
/// @throws FileError if the bytes are not a figure of that format
std::string finished(std::string bytes, Format format, const std::string& title);

/// Returns a script that shows whether gnuplot finds a font. Without a font gnuplot draws blanks, without a message.
std::string font_probe();
/// @param probed output of font_probe()   @throws FileError that names the package to install
void require_font(const std::string& probed);

}  // namespace hamflow::figures
