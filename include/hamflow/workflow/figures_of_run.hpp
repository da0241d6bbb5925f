// Draws figures from the files of runs.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hamflow/detail/run/run_tables.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

namespace figures {
struct Page;
}

struct FigureRequest {
  std::vector<std::filesystem::path> runs;  // folders or run.h5 of finished, running or interrupted runs
  std::string kind{};                       // see figure_kinds(); empty: usual_figure() of the first run
  std::filesystem::path file;               // .svg, .pdf or .png
  std::string x{};                          // a column, for kinds that draw columns; empty: the default
  std::vector<std::string> y{};             // columns, for the same kinds; empty: the default
  std::vector<double> at{};                 // times, for kinds that draw single samples; empty: the default
  std::string size{};                       // "8.5x6" (centimetres), "85x60mm", "3.35x2.4in"; empty: the default
  int dpi = 0;                              // pixels per inch of a .png; 0: 300
  bool title = true;
  std::function<void(const std::string&)> note{};  // called for times without a sample and for parts left out
};

/// Draws one figure of one or several runs. The legend of several runs names the settings in which they differ.
/// @throws Error if the runs have no such figure   @throws FileError
void draw_figure(const FigureRequest& request);

/// Draws one figure of a run with the default columns, times and size.
void draw_figure(const std::filesystem::path& run, const std::string& kind, const std::filesystem::path& file);

/// Makes the figure of a run in memory (hamflow/figures/page.hpp).
/// @param request its kind, columns and times are used; its runs and file are not
/// @throws Error if the run has no such figure
figures::Page figure_page(const Scenario& scenario, const RunTables& tables, const FigureRequest& request);

/// Draws the figures that output.figures of the scenario requests, each as .svg, .pdf and .png, into figures/ of the
/// folder of the run.
/// @param tables tables of the run; null: they are read from its folder
/// @return the reason for each figure that could not be drawn, for example a section without points   @throws FileError
std::vector<std::string> draw_figures(const Scenario& scenario, const std::filesystem::path& folder,
                                      const RunTables* tables = nullptr);

}  // namespace hamflow
