// Draws a sweep: a column of its table as a function of the varied keys.
#pragma once

#include <filesystem>
#include <string>

#include "sweep.hpp"

namespace hamflow {

/// Checks that the figure can be drawn.   @throws Rejection
void check_sweep_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& colour);

/// @throws Error, FileError
void draw_sweep_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& colour);

/// The same for means of columns (names separated by commas) over all varied keys except the first, with standard
/// errors.
void check_mean_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& columns);
/// @throws Error, FileError
void draw_mean_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& columns);

}  // namespace hamflow
