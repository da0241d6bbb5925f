#include "progress.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>

namespace hamflow::app {

namespace {
volatile sig_atomic_t asked_to_stop = 0;
extern "C" void note_interrupt(int) { asked_to_stop = 1; }
}  // namespace

void catch_interrupts() {
  asked_to_stop = 0;
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup means it
}

bool interrupted() { return asked_to_stop != 0; }

Progress::Progress(std::int64_t first, std::int64_t steps, bool quiet)
    : first_(first), steps_(steps), visible_(!quiet && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::show(std::int64_t step) {
  if (!visible_ || steps_ == 0) return;
  const Clock::time_point now = Clock::now();
  if (std::chrono::duration<double>(now - last_).count() < 0.1) return;
  last_ = now;
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  const double part = static_cast<double>(step) / static_cast<double>(steps_);
  const double rate = static_cast<double>(step - first_) / seconds;
  constexpr int width = 30;
  const auto filled = static_cast<std::size_t>(part * width);
  fmt::print(stderr, "\r[{:<{}}] {:5.1f} %  {:.3g} steps/s  {:.0f} s left\033[K", std::string(filled, '='), width,
             100 * part, rate, static_cast<double>(steps_ - step) / rate);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace hamflow::app
