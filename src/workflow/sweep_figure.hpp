// The figure of a sweep: a column of its table over the keys that were varied.
#pragma once

#include <filesystem>
#include <string>

#include "sweep.hpp"

namespace hamflow {

/// Empty if the figure can be drawn, else what is wrong with the request for it.
void check_sweep_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& colour);

/// @throws Error, FileError
void draw_sweep_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& colour);

/// The same of the means of columns, commas between, over all varied keys but the first, with their standard errors.
void check_mean_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& columns);
/// @throws Error, FileError
void draw_mean_figure(const Sweep& sweep, const std::filesystem::path& file, const std::string& columns);

}  // namespace hamflow
