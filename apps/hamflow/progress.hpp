// Progress on stderr: a line that is redrawn if stderr is a terminal, else one note about a long run. Also the handling
// of Ctrl-C, which stops a run at the end of a step.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace hamflow::app {

/// After this call, Ctrl-C only requests a stop. If interrupted() has not been called a second later, a line on stderr
/// explains the wait; from then on another Ctrl-C ends the program at once.
void catch_interrupts();
bool interrupted();

/// Marks the work before the first step, which cannot be interrupted and has no result yet. While the object exists,
/// Ctrl-C ends the program within a second, even if nobody calls interrupted(); after 20 s a line on stderr says which
/// work takes the time. Only one object may exist at a time.
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
  /// The same for work that is not counted in steps. @param part finished, in [0, 1]   @param what e.g. "run 3 of 66"
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
  bool noted_ = false;  // the note was printed, because stderr is not a terminal
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

}  // namespace hamflow::app
