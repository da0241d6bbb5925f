#include "progress.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>

namespace hamflow::app {

namespace {
volatile sig_atomic_t asked_to_stop = 0;
extern "C" void note_interrupt(int) { asked_to_stop = 1; }

void handle_interrupts(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup means it
}
}  // namespace

void catch_interrupts() {
  asked_to_stop = 0;
  handle_interrupts(note_interrupt);
}

bool interrupted() { return asked_to_stop != 0; }

Progress::Progress(std::int64_t first, std::int64_t steps, bool quiet)
    : first_(first), steps_(steps), visible_(!quiet && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

bool Progress::is_due() {
  if (!visible_) return false;
  const Clock::time_point now = Clock::now();
  if (std::chrono::duration<double>(now - last_).count() < 0.1) return false;
  last_ = now;
  return true;
}

void Progress::draw(double part, const std::string& text) {
  constexpr int width = 30;
  const auto filled = static_cast<std::size_t>(part * width);
  fmt::print(stderr, "\r[{:<{}}] {:5.1f} %  {}\033[K", std::string(filled, '='), width, 100 * part, text);
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::show(std::int64_t step) {
  if (steps_ == 0 || !is_due()) return;
  const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
  const double rate = static_cast<double>(step - first_) / seconds;
  const double part = static_cast<double>(step) / static_cast<double>(steps_);
  // Before the first step there is no rate to tell the time left from.
  draw(part, rate > 0 ? fmt::format("{:.3g} steps/s  {:.0f} s left", rate, static_cast<double>(steps_ - step) / rate)
                      : std::string("before the first step"));
}

void Progress::show(double part, std::optional<double> seconds_left, const std::string& what) {
  if (!is_due()) return;
  draw(part, seconds_left ? fmt::format("{}  {:.0f} s left", what, *seconds_left) : what);
}

}  // namespace hamflow::app
