// Leaves a measurement that was asked to stop.
#pragma once

#include "hamflow/core/stop_question.hpp"

namespace hamflow {

/// Thrown out of measure_method() if a StopQuestion of its thread requests a stop.
struct MeasuringStopped {};

/// To be called between the runs of a measurement, none of which takes long.
inline void leave_if_stopped() {
  if (StopQuestion::stop_requested()) throw MeasuringStopped();
}

}  // namespace hamflow
