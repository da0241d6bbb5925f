// Time is an integer number of steps: t = t0 + n h. Nobody writes t += h, and no step is shortened to hit an end.
#pragma once

#include <cstdint>

namespace hamflow {

/// Counts equal steps of length h from t0. Reversing turns the direction, so that going back meets the same times.
template <class R = double>
class StepClock {
 public:
  StepClock() = default;
  /// @param start time of step 0   @param step length h of a step, may be negative
  StepClock(R start, R step) : start_(start), step_(step) {}

  R step() const { return step_; }  // forwards
  R step_length() const { return direction_ < 0 ? -step_ : step_; }
  /// t0 + n h, with one rounding in the product and one in the sum, whatever the number of steps taken.
  R time() const { return time_after(0); }
  /// The time that so many steps from now will have.
  R time_after(std::int64_t steps) const { return start_ + static_cast<R>(position_ + direction_ * steps) * step_; }
  R start() const { return start_; }
  /// Steps from the start of time, and the direction in which they are counted.
  std::int64_t position() const { return position_; }
  std::int64_t direction() const { return direction_; }
  /// Steps taken, in either direction.
  std::int64_t steps_taken() const { return taken_; }

  void advance(std::int64_t steps) {
    position_ += direction_ * steps;
    taken_ += steps;
  }
  void reverse() { direction_ = -direction_; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(start_, step_, position_, taken_, direction_);
  }

 private:
  R start_{};
  R step_{};
  std::int64_t position_ = 0;
  std::int64_t taken_ = 0;
  std::int64_t direction_ = 1;
};

}  // namespace hamflow
