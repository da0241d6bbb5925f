// From the files of a run to its figures.
#pragma once

#include <filesystem>
#include <string>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// Draws one figure of a run.   @param run its folder or run.h5, also of a run that goes on or was cut short
/// @param kind see figure_kinds(); empty: usual_figure()
/// @param file .svg, .pdf or .png   @throws Error when the run has no such figure   @throws FileError
void draw_figure(const std::filesystem::path& run, const std::string& kind, const std::filesystem::path& file);

/// Draws those that the scenario requests in output.figures, each as .svg, .pdf and .png, into figures/ of the folder
/// of its run.   @throws Error, FileError
void draw_figures(const Scenario& scenario, const std::filesystem::path& folder);

}  // namespace hamflow
