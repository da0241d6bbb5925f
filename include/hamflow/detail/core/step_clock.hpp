// Time is an integer number of steps: t = t0 + n h. It is never accumulated (t += h), and no step is shortened to hit
// an end time.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "hamflow/core/dual.hpp"
#include "hamflow/core/phase_point.hpp"

namespace hamflow {

/// A time as an unevaluated sum: `whole` is the rounded sum, or a neighbour of it, `rest` its rounding error.
template <class R>
struct TimeWords {
  R whole{};
  R rest{};
};

/// start + n step for a whole number n.   [Dekker1971; the exact sum of two numbers: Knuth1997, 4.2.2]
template <class R>
TimeWords<R> time_in_words(const R& start, const R& n, const R& step) {
  using Base = base_scalar<R>;
  const R product = n * step;
  R lost(0);
  if constexpr (std::is_floating_point_v<Base>) {
    const auto upper_half = [](const R& x) {
      const R large = R(static_cast<Base>(1ULL << ((std::numeric_limits<Base>::digits + 1) / 2)) + 1) * x;
      return R(large - (large - x));
    };
    const R n1 = upper_half(n);
    const R n0 = n - n1;
    const R step1 = upper_half(step);
    const R step0 = step - step1;
    lost = ((n1 * step1 - product) + n1 * step0 + n0 * step1) + n0 * step0;
  } else {  // n and step1 have the digits of a double: their product is exact in R
    const R step1(static_cast<double>(step));
    lost = (n * step1 - product) + n * R(step - step1);
  }
  const R whole = start + product;
  const R part = whole - start;
  return {whole, ((start - (whole - part)) + (product - part)) + lost};
}

/// For H(q, p, t) the last two coordinates hold the time: the time since the step began, with t' = 1, and the time at
/// which the step began. Methods treat them like any coordinate. After every step the clock of the run sets both, so
/// that no rounding error of the time reaches the next step. The time of a stage is n h, in two words, plus the
/// increments of earlier stages of the same step, rounded once.
inline constexpr std::size_t clock_coordinates = 2;

/// A problem behind virtual calls, which knows at run time whether its last coordinates hold the time.
template <class P>
concept MayHaveClock = requires(const P& problem) {
  { problem.has_clock() } -> std::same_as<bool>;
};
template <class P>
bool has_clock([[maybe_unused]] const P& problem) {
  if constexpr (MayHaveClock<P>) {
    return problem.has_clock();
  } else {
    return false;
  }
}
/// The number of coordinates that hold the time. They do not enter the scale of errors.
template <class P>
std::size_t clocks_of(const P& problem) {
  return has_clock(problem) ? clock_coordinates : 0;
}

/// Sets these coordinates to the time `begin` and the time passed since then.
/// @param passed in the number type of the state
template <class A, std::size_t N, class R>
void set_clock(PhasePoint<A, N>& z, const TimeWords<R>& begin, const R& passed = R(0)) {
  const std::size_t n = z.q.size();
  z.q[n - 1] = z.arithmetic.position.store(begin.whole);
  z.q[n - 2] = z.arithmetic.position.store(R(begin.rest + passed));
  z.p[n - 1] = z.arithmetic.momentum.store(R(0));
}

/// Counts equal steps of length h from t0. Reversing changes the direction, so that the steps back have the same times.
template <class R = double>
class StepClock {
 public:
  StepClock() = default;
  /// @param start time of step 0   @param step size h of a step, may be negative
  StepClock(R start, R step) : start_(start), step_(step) {}

  R step() const { return step_; }  // in forward direction
  R step_length() const { return direction_ < 0 ? -step_ : step_; }
  /// t0 + n h, with one rounding in the product and one in the sum, whatever the number of steps taken.
  R time() const { return time_after(0); }
  /// The time after the given number of further steps.
  R time_after(std::int64_t steps) const { return start_ + static_cast<R>(position_ + direction_ * steps) * step_; }
  /// The earlier end (in forward direction) of the step that follows the given number of further steps. Forward and
  /// backward steps count the times of stages from the same end.
  TimeWords<R> begin_after(std::int64_t steps) const {
    return time_in_words(start_, static_cast<R>(position_ + direction_ * steps - (direction_ < 0 ? 1 : 0)), step_);
  }
  /// The time from that end at which the step begins.
  R passed() const { return direction_ < 0 ? step_ : R(0); }
  R start() const { return start_; }
  /// Steps between t0 and now; negative before t0.
  std::int64_t position() const { return position_; }
  std::int64_t direction() const { return direction_; }
  /// The number of steps taken in both directions.
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
