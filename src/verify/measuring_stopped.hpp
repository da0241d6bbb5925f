// Ends a measurement that was asked to stop.
#pragma once

#include "hamflow/core/stop_question.hpp"

namespace hamflow {

/// Thrown by measure_method() if a StopQuestion of its thread requests a stop.
struct MeasuringStopped {};

/// Call this between the runs of a measurement, because a single run does not take long.
inline void throw_if_stopped() {
  if (StopQuestion::stop_requested()) throw MeasuringStopped();
}

}  // namespace hamflow
