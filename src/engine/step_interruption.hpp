// Interruption of a step in many digits, where a single evaluation of a force takes seconds. The functions of a
// problem, in which every method spends its time, check for a requested stop (src/engine/interruptible_functions.hpp)
// and throw; the simulation then restores its state (src/engine/mp_simulation.cpp).
#pragma once

#include <utility>

#include "hamflow/core/stop_question.hpp"

namespace hamflow {

class StepInterruption {
 public:
  /// Thrown to leave the step.
  struct Taken {};
  StepInterruption() : before_(std::exchange(is_open(), true)) {}
  ~StepInterruption() { is_open() = before_; }
  StepInterruption(const StepInterruption&) = delete;
  StepInterruption& operator=(const StepInterruption&) = delete;
  /// Leaves the step if a stop is requested and a StepInterruption exists in this thread.
  static void ask() {
    if (is_open() && StopQuestion::stop_requested()) throw Taken{};
  }

 private:
  static bool& is_open() {
    thread_local bool open = false;
    return open;
  }
  bool before_;
};

}  // namespace hamflow
