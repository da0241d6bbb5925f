// Whether somebody wants to stop, asked within a step that takes long: the sub-steps of a reference solution of many
// bodies are minutes in one step.
#pragma once

#include <chrono>
#include <functional>
#include <utility>

namespace hamflow {

/// While it lives, methods of this thread that ask are answered by goes_on, a few times a second.
class StopQuestion {
 public:
  explicit StopQuestion(const std::function<bool()>& goes_on)
      : goes_on_(&goes_on), before_(std::exchange(here(), this)) {}
  ~StopQuestion() { here() = before_; }
  StopQuestion(const StopQuestion&) = delete;
  StopQuestion& operator=(const StopQuestion&) = delete;
  /// While it lives, nobody is asked: of what has to be done whole, whoever wants to stop.
  class Silence {
   public:
    Silence() : before_(std::exchange(here(), nullptr)) {}
    ~Silence() { here() = before_; }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;

   private:
    StopQuestion* before_;
  };
  /// Once it is true it stays so.
  static bool answered() { return here() != nullptr && here()->asked(); }

 private:
  using Clock = std::chrono::steady_clock;
  bool asked() {
    const Clock::time_point now = Clock::now();
    if (stop_ || now - last_ < std::chrono::milliseconds(200)) return stop_;
    last_ = now;
    return stop_ = !(*goes_on_)();
  }
  static StopQuestion*& here() {
    thread_local StopQuestion* question = nullptr;
    return question;
  }
  const std::function<bool()>* goes_on_;
  StopQuestion* before_;
  Clock::time_point last_ = Clock::now();
  bool stop_ = false;
};

}  // namespace hamflow
