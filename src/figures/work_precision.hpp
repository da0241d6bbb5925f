// **Work-precision figure**: what accuracy costs, method by method, on logarithmic axes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hamflow/figures/page.hpp"

namespace hamflow {

/// One method; one entry per step length, NaN where a run failed.
struct WorkCurve {
  std::string name;
  int order = 0;  // 0: it varies along the curve
  bool explicit_step = true;
  std::vector<double> evaluations;
  std::vector<double> seconds;
  std::vector<double> error;
  std::vector<double> energy_error;
};

struct WorkPrecision {
  std::string title;
  std::vector<WorkCurve> curves;
  double floor = 0;  // the uncertainty of the reference: errors below it mean nothing
  double size = 1;   // of the motion, its largest coordinate or momentum
};

/// @throws Error where there is no error to draw
figures::Page work_precision_page(const WorkPrecision& data);
/// Writes svg, pdf or png by the extension of `file`.
/// @throws Error when the extension or the data do not fit   @throws FileError when gnuplot or the file fails
void write_work_precision(const WorkPrecision& data, const std::filesystem::path& file);

}  // namespace hamflow
