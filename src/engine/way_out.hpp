// A way out of a step in many digits: a single evaluation of a force takes seconds there, and the functions of a
// problem are where every method spends them. They ask (src/engine/asking_functions.hpp), and the simulation that
// opened the way goes back to where it stood (src/engine/mp_simulation.cpp).
#pragma once

#include <utility>

#include "hamflow/core/stop_question.hpp"

namespace hamflow {

class StepInterruption {
 public:
  /// Thrown out of the step.
  struct Taken {};
  StepInterruption() : before_(std::exchange(is_open(), true)) {}
  ~StepInterruption() { is_open() = before_; }
  StepInterruption(const StepInterruption&) = delete;
  StepInterruption& operator=(const StepInterruption&) = delete;
  /// Leaves the step if somebody wants to stop. Where no way is open in this thread, nothing happens.
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
