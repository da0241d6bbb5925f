// A progress line on stderr when it is a terminal, one note about a long run when it is not; and Ctrl-C, which stops at
// a step boundary.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace hamflow::app {

/// From now on Ctrl-C only asks to stop. Where nobody has called interrupted() a second later, a line on stderr says
/// what is waited for; from then on another Ctrl-C ends the program at once.
void catch_interrupts();
bool interrupted();

/// Work before the first step, which cannot be interrupted and has no result yet. While it lives, Ctrl-C ends the
/// program within a second, even if nobody calls interrupted(); after 20 s a line on stderr says what takes the time.
/// One at a time.
class Preparation {
 public:
  /// @param what "setting up the run"   @param json whether stdout gets a JSON text when Ctrl-C ends the program
  Preparation(const std::string& what, bool json, bool quiet);
  ~Preparation();
  Preparation(const Preparation&) = delete;
  Preparation& operator=(const Preparation&) = delete;
};

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
  bool quiet_;
  bool is_terminal_;
  bool drawn_ = false;
  bool noted_ = false;  // elsewhere than on a terminal
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

}  // namespace hamflow::app
