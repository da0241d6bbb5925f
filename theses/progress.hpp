// Handles Ctrl-C, and shows progress.
#pragma once

#include <chrono>
#include <cstddef>

namespace hamflow::reproduction {

/// After this call, the signals INT, TERM and HUP make interrupted() return true. A further signal, a second later or
/// more, ends the program at once with status 130.
void catch_interrupts();
bool interrupted();

/// Shows progress on stderr: a bar on a terminal, else a single note once the work has taken 20 seconds.
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
