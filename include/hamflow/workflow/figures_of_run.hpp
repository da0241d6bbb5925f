// From the files of runs to their figures.
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
  std::vector<std::filesystem::path> runs;  // folders or run.h5, also of runs that go on or were cut short
  std::string kind{};                       // see figure_kinds(); empty: usual_figure() of the first run
  std::filesystem::path file;               // .svg, .pdf or .png
  std::string x{};                          // a column, of the kinds that draw columns; empty: as is usual
  std::vector<std::string> y{};             // the same
  std::vector<double> at{};                 // times, of the kinds that draw some of them; empty: as is usual
  std::string size{};                       // "8.5x6" (centimetres), "85x60mm", "3.35x2.4in"; empty: as is usual
  int dpi = 0;                              // pixels to the inch, of a .png; 0: 300
  bool title = true;
  std::function<void(const std::string&)> note{};  // is told of times without a sample, and of what is left out
};

/// Draws one figure of one run, or of several with a legend of what differs between them.
/// @throws Error when the runs have no such figure   @throws FileError
void draw_figure(const FigureRequest& request);

/// Draws one figure of a run as it is usual.
void draw_figure(const std::filesystem::path& run, const std::string& kind, const std::filesystem::path& file);

/// The figure of a run in memory (hamflow/figures/page.hpp).
/// @param request its kind, columns and times; its runs and file are not used   @throws Error when the run has no such
/// figure
figures::Page figure_page(const Scenario& scenario, const RunTables& tables, const FigureRequest& request);

/// Draws those that the scenario requests in output.figures, each as .svg, .pdf and .png, into figures/ of the folder
/// of its run.   @param tables of the run; null: they are read from its folder   @return why those are missing that
/// what came of the run does not allow: a section without points
/// @throws FileError
std::vector<std::string> draw_figures(const Scenario& scenario, const std::filesystem::path& folder,
                                      const RunTables* tables = nullptr);

}  // namespace hamflow
