// Ctrl-C, and how far the work has come.
#pragma once

#include <chrono>
#include <cstddef>

namespace hamflow::reproduction {

/// From here on INT, TERM and HUP ask the program to stop: interrupted() becomes true. A second one, a second later,
/// ends it at once with status 130.
void catch_interrupts();
bool interrupted();

/// A bar on a terminal; elsewhere one note, once the work has taken 20 seconds. All on stderr.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::size_t done, std::size_t all);

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool is_terminal_;
  bool drawn_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

}  // namespace hamflow::reproduction
