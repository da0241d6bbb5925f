// **Work-precision figure**: the work that an accuracy costs, for each method, on logarithmic axes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hamflow/figures/page.hpp"

namespace hamflow {

/// Data of one method, with an entry for each step size; NaN if a run failed.
struct WorkCurve {
  std::string name;
  int order = 0;  // 0: the order varies along the curve
  bool explicit_step = true;
  std::vector<double> evaluations;
  std::vector<double> seconds;
  std::vector<double> error;
  std::vector<double> energy_error;
};

struct WorkPrecision {
  std::string title;
  std::vector<WorkCurve> curves;
  double floor = 0;  // uncertainty of the reference; errors below it mean nothing
  double size = 1;   // size of the motion, its largest coordinate or momentum
};

/// @throws Error if there is no error to draw
figures::Page work_precision_page(const WorkPrecision& data);
/// Writes SVG, PDF or PNG, by the extension of `file`.
/// @throws Error if the extension or the data do not fit   @throws FileError if gnuplot or writing fails
void write_work_precision(const WorkPrecision& data, const std::filesystem::path& file);

}  // namespace hamflow
