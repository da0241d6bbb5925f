#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <string>
#include <string_view>

namespace hamflow::reproduction {

namespace {
volatile std::sig_atomic_t asked_to_stop = 0;
volatile std::sig_atomic_t answered = 0;  // 1 once interrupted() has returned true
volatile std::sig_atomic_t stops_at_once = 0;

extern "C" void note_interrupt(int) {
  if (stops_at_once != 0) _exit(130);
  if (asked_to_stop == 0) alarm(1);
  asked_to_stop = 1;
}

extern "C" void note_time(int) {
  const int error = errno;
  stops_at_once = 1;
  constexpr std::string_view text = "note: stopping at the end of this step; Ctrl-C again stops at once\n";
  if (answered == 0 && write(STDERR_FILENO, text.data(), text.size()) < 0) answered = 1;  // uses the result of write
  errno = error;
}

void handle(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigaction(signal, &action, nullptr);
}
}  // namespace

void catch_interrupts() {
  handle(SIGALRM, note_time, SA_RESTART);
  handle(SIGINT, note_interrupt, 0);
  handle(SIGTERM, note_interrupt, 0);
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) handle(SIGHUP, note_interrupt, 0);  // nohup sets SIG_IGN, which has to stay
}

bool interrupted() {
  if (asked_to_stop != 0) answered = 1;
  return asked_to_stop != 0;
}

Progress::Progress(bool quiet) : quiet_(quiet), is_terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (drawn_ && is_terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::show(std::size_t done, std::size_t all) {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  const bool is_due = is_terminal_ ? now - last_ > std::chrono::milliseconds(100) : seconds > 20 && !drawn_;
  if (quiet_ || !is_due) return;
  last_ = now;
  drawn_ = true;
  const double part = static_cast<double>(done) / static_cast<double>(all);
  std::string text = fmt::format("experiment {} of {}", std::min(done + 1, all), all);
  if (done > 0) {
    const double left = seconds * (1 - part) / part;
    text += left < 120 ? fmt::format("  {:.0f} s left", left) : fmt::format("  {:.3g} min left", left / 60);
  }
  if (is_terminal_) {
    constexpr int width = 30;
    const std::string filled(static_cast<std::size_t>(part * width), '=');
    fmt::print(stderr, "\r[{:<{}}] {:5.1f} %  {}\033[K", filled, width, 100 * part, text);
  } else {
    fmt::print(stderr, "note: {:.1f} %  {}\n", 100 * part, text);
  }
  std::fflush(stderr);
}

}  // namespace hamflow::reproduction
