// From the files of a run to its figures.
#pragma once

#include <filesystem>
#include <string>

namespace hamflow {

/// Draws one figure of a run. @param run its folder or run.h5, also of a run that goes on or was cut short
/// @param kind see figure_kinds(); empty: usual_figure()
/// @throws Error, FileError
void draw_figure(const std::filesystem::path& run, const std::string& kind, const std::filesystem::path& file);

}  // namespace hamflow
