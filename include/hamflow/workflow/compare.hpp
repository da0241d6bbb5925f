// Work and precision: several methods with several steps on one problem, their table, files and figure.
#pragma once

#include <filesystem>

#include "hamflow/core/complaint.hpp"
#include "hamflow/verify/comparison.hpp"
#include "hamflow/workflow/work_folder.hpp"

namespace hamflow {

namespace figures {
struct Page;
}

/// What a comparison is asked for, as it was typed.
struct ComparisonInput {
  std::string text;                  // of the scenario, whose own method is not run
  std::string name;                  // stands in messages
  std::vector<std::string> sets{};   // PATH=VALUE texts that override the scenario
  std::vector<std::string> methods;  // e.g. "cg(1,5)"
  std::vector<std::string> dts{};    // number expressions; none: from twice the scenario's dt to a sixteenth of it
};

struct ComparisonReading {
  ComparisonRequest request;
  std::vector<std::string> notes;     // remarks about an accepted request
  std::vector<Complaint> complaints;  // nothing can be run while there is one
};

/// @throws Rejection when the scenario is wrong with every method
ComparisonReading read_comparison(const ComparisonInput& input);

struct ComparisonReport {
  Comparison comparison;
  std::string status;   // "done", "interrupted"; "failed": no run came to its end
  std::string message;  // of a failure, a sentence
  std::string json;
  std::string csv;
  std::string text;  // for people
  std::string hint;  // of a failure: what can be tried
  std::vector<std::string> warnings{};
};

/// @param progress told how far the comparison is; returns false to stop   @throws Error
ComparisonReport compare_methods(const ComparisonRequest& request,
                                 const std::function<bool(const ComparisonProgress&)>& progress = {});
/// The work-precision figure (hamflow/figures/page.hpp).   @throws Error where no run has an error to draw
figures::Page comparison_page(const Comparison& comparison);
/// The same in a file.   @param file .svg, .pdf or .png   @throws Error, FileError
void draw_comparison(const Comparison& comparison, const std::filesystem::path& file);

/// Empty if the file's extension is that of a figure, else what is wrong with it.
std::string refused_comparison_figure(const std::filesystem::path& file);

/// Writes compare.json, compare.csv and, where there is something to draw, figures/ into a comparison_folder().
/// @throws FileError
void write_comparison(const ComparisonReport& report, const WorkFolder& folder);

}  // namespace hamflow
