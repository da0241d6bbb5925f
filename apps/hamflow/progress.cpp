#include "progress.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "commands.hpp"
#include "hamflow/detail/workflow/rejection_json.hpp"

namespace hamflow::app {

namespace {
volatile sig_atomic_t asked_to_stop = 0;
volatile sig_atomic_t answered = 0;       // the computation has called interrupted() since asked_to_stop was set
volatile sig_atomic_t stops_at_once = 0;  // the next signal ends the process
volatile sig_atomic_t preparing = 0;
constexpr double grace = 0.8;        // grace period after Ctrl-C, in seconds, before a line on stderr explains the wait
constexpr double long_start = 20;    // seconds until a preparation prints what it does
constexpr double long_silence = 20;  // seconds until a run without a terminal prints the time left

// These strings are written while no timer runs; the handler of the timer reads them.
std::string long_start_text;
std::string stopped_json;

void start_timer(double seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  timer.it_value.tv_usec = static_cast<suseconds_t>((seconds - std::floor(seconds)) * 1e6);
  setitimer(ITIMER_REAL, &timer, nullptr);
}

/// Uses write(), which is allowed in a signal handler.
void say(int file, const char* text, std::size_t size) {
  const ssize_t ignored = write(file, text, size);
  (void)ignored;
}

extern "C" void note_interrupt(int) {
  if (stops_at_once != 0) _exit(exit_interrupted);
  if (asked_to_stop == 0) start_timer(grace);
  asked_to_stop = 1;
}

extern "C" void note_time(int) {
  const int error = errno;
  if (asked_to_stop == 0) {
    if (preparing != 0) say(STDERR_FILENO, long_start_text.data(), long_start_text.size());
  } else if (preparing != 0 && answered == 0) {
    constexpr std::string_view text = "error: stopped before the first step; nothing was computed\n";
    say(STDERR_FILENO, text.data(), text.size());
    say(STDOUT_FILENO, stopped_json.data(), stopped_json.size());
    _exit(exit_interrupted);
  } else {
    stops_at_once = 1;
    constexpr std::string_view text = "note: stopping at the end of this step; Ctrl-C again stops at once\n";
    if (answered == 0) say(STDERR_FILENO, text.data(), text.size());
  }
  errno = error;
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = signal == SIGALRM ? SA_RESTART : 0;
  sigaction(signal, &action, nullptr);
}

/// "40 s", "3 h", "2.9e+08 years".
std::string duration(double seconds) {
  const std::pair<double, const char*> units[] = {
      {86400 * 365.25, "years"}, {86400, "days"}, {3600, "h"}, {60, "min"}, {1, "s"}};
  for (const auto& [size, name] : units) {
    if (seconds >= 2 * size) return fmt::format("{:.3g} {}", seconds / size, name);
  }
  return fmt::format("{:.0f} s", seconds);
}
}  // namespace

void catch_interrupts() {
  asked_to_stop = 0;
  answered = 0;
  stops_at_once = 0;
  handle(SIGALRM, note_time);
  handle(SIGINT, note_interrupt);
  handle(SIGTERM, note_interrupt);
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) handle(SIGHUP, note_interrupt);  // nohup ignores SIGHUP, and that is kept
}

bool interrupted() {
  if (asked_to_stop != 0) answered = 1;
  return asked_to_stop != 0;
}

Preparation::Preparation(const std::string& what, bool json, bool quiet) {
  start_timer(0);
  long_start_text =
      quiet ? "" : fmt::format("note: {} has taken {:g} s so far and continues; Ctrl-C stops it\n", what, long_start);
  stopped_json = json ? failure_json("interrupted", "stopped before the first step; nothing was computed") : "";
  preparing = 1;
  handle(SIGALRM, note_time);
  start_timer(long_start);
}

Preparation::~Preparation() {
  preparing = 0;
  if (asked_to_stop == 0) start_timer(0);
}

Progress::Progress(std::int64_t first, std::int64_t steps, bool quiet)
    : first_(first), steps_(steps), quiet_(quiet), is_terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

bool Progress::is_due() {
  if (quiet_ || noted_) return false;
  const Clock::time_point now = Clock::now();
  const bool is_early = !is_terminal_ && std::chrono::duration<double>(now - begin_).count() < long_silence;
  if (is_early || std::chrono::duration<double>(now - last_).count() < 0.1) return false;
  last_ = now;
  return true;
}

void Progress::draw(double part, const std::string& text) {
  if (!is_terminal_) {
    fmt::print(stderr, "note: {:.1f} %  {}\n", 100 * part, text);
    noted_ = true;
    return;
  }
  constexpr int width = 30;
  const auto filled = static_cast<std::size_t>(part * width);
  fmt::print(stderr, "\r[{:<{}}] {:5.1f} %  {}\033[K", std::string(filled, '='), width, 100 * part, text);
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::show(std::int64_t step) {
  if (steps_ == 0 || (step == first_ && !is_terminal_) || !is_due()) return;  // the only note has to tell the time left
  const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
  const double rate = static_cast<double>(step - first_) / seconds;
  const double part = static_cast<double>(step) / static_cast<double>(steps_);
  // The time left follows from the rate, which is unknown before the first step.
  draw(part, rate > 0
                 ? fmt::format("{:.3g} steps/s  {} left", rate, duration(static_cast<double>(steps_ - step) / rate))
                 : std::string("before the first step"));
}

void Progress::show(double part, std::optional<double> seconds_left, const std::string& what) {
  if (!is_due()) return;
  draw(part, seconds_left ? fmt::format("{}  {} left", what, duration(*seconds_left)) : what);
}

}  // namespace hamflow::app
