// A progress line on stderr when it is a terminal, nothing when it is not; and Ctrl-C, which stops at a step boundary.
#pragma once

#include <chrono>
#include <cstdint>

namespace hamflow::app {

/// From now on Ctrl-C only asks to stop.
void catch_interrupts();
bool interrupted();

class Progress {
 public:
  /// @param first step at which this part of the run begins
  Progress(std::int64_t first, std::int64_t steps, bool quiet);
  ~Progress();
  /// Redraws at most ten times a second.
  void show(std::int64_t step);

 private:
  using Clock = std::chrono::steady_clock;
  std::int64_t first_;
  std::int64_t steps_;
  bool visible_;
  bool drawn_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

}  // namespace hamflow::app
