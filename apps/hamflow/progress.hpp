// A progress line on stderr when it is a terminal, nothing when it is not; and Ctrl-C, which stops at a step boundary.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

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
  /// The same of work that is not steps. @param part of the time, in [0, 1]   @param what e.g. "run 3 of 66"
  void show(double part, std::optional<double> seconds_left, const std::string& what);

 private:
  bool is_due();
  void draw(double part, const std::string& text);
  using Clock = std::chrono::steady_clock;
  std::int64_t first_;
  std::int64_t steps_;
  bool visible_;
  bool drawn_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

}  // namespace hamflow::app
