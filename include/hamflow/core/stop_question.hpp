// Cancellation of a long step: methods ask during a step whether the caller wants to stop, because the sub-steps of a
// reference solution of many bodies can take minutes.
#pragma once

#include <chrono>
#include <functional>
#include <utility>

namespace hamflow {

/// While this object exists, methods of this thread ask goes_on a few times per second whether to continue.
class StopQuestion {
 public:
  explicit StopQuestion(const std::function<bool()>& goes_on)
      : goes_on_(&goes_on), before_(std::exchange(here(), this)) {}
  ~StopQuestion() { here() = before_; }
  StopQuestion(const StopQuestion&) = delete;
  StopQuestion& operator=(const StopQuestion&) = delete;
  /// While this object exists, goes_on is not asked: for work that must be completed.
  class Suspended {
   public:
    Suspended() : before_(std::exchange(here(), nullptr)) {}
    ~Suspended() { here() = before_; }
    Suspended(const Suspended&) = delete;
    Suspended& operator=(const Suspended&) = delete;

   private:
    StopQuestion* before_;
  };
  /// Whether the caller wants to stop; stays true once it is true.
  static bool stop_requested() { return here() != nullptr && here()->asked(); }

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
