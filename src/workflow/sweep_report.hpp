// Makes the summary of a sweep.
#pragma once

#include "hamflow/detail/workflow/sweep_summary.hpp"
#include "sweep.hpp"

namespace hamflow {

SweepSummary sweep_summary(const Sweep& sweep, double seconds, bool interrupted, bool with_rows);

}  // namespace hamflow
