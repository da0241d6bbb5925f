// Work-precision comparison: runs several methods with several step sizes on one problem, and makes a table, files and
// a figure.
#pragma once

#include <filesystem>

#include "hamflow/core/complaint.hpp"
#include "hamflow/verify/comparison.hpp"
#include "hamflow/workflow/work_folder.hpp"

namespace hamflow {

namespace figures {
struct Page;
}

/// A comparison as the user typed it.
struct ComparisonInput {
  std::string text;                  // text of the scenario; its own method is not run
  std::string name;                  // name of the scenario in messages
  std::vector<std::string> sets{};   // PATH=VALUE texts that override the scenario
  std::vector<std::string> methods;  // for example "cg(1,5)"
  std::vector<std::string> dts{};    // number expressions; empty: from twice the scenario's dt to a sixteenth of it
};

struct ComparisonReading {
  ComparisonRequest request;
  std::vector<std::string> notes;     // remarks about an accepted request
  std::vector<Complaint> complaints;  // if not empty, the comparison cannot run
};

/// @throws Rejection if the scenario is wrong with every method
ComparisonReading read_comparison(const ComparisonInput& input);

struct ComparisonReport {
  Comparison comparison;
  std::string status;   // "done", "interrupted"; "failed": no run reached its end
  std::string message;  // after a failure: a sentence that says what failed
  std::string json;
  std::string csv;
  std::string text;  // the table as text
  std::string hint;  // after a failure: what can be tried
  std::vector<std::string> warnings{};
};

/// @param progress called with the state of the comparison; returns false to stop   @throws Error
ComparisonReport compare_methods(const ComparisonRequest& request,
                                 const std::function<bool(const ComparisonProgress&)>& progress = {});
/// Returns the work-precision figure (hamflow/figures/page.hpp).   @throws Error if no run has an error that can be
/// drawn
figures::Page comparison_page(const Comparison& comparison);
/// Draws the work-precision figure into a file.   @param file .svg, .pdf or .png   @throws Error, FileError
void draw_comparison(const Comparison& comparison, const std::filesystem::path& file);

/// Returns an empty text if the file has the extension of a figure, otherwise the reason why it is refused.
std::string refused_comparison_figure(const std::filesystem::path& file);

/// Writes compare.json, compare.csv and, if an error can be drawn, figures/ into a comparison_folder().
/// @throws FileError
void write_comparison(const ComparisonReport& report, const WorkFolder& folder);

}  // namespace hamflow
