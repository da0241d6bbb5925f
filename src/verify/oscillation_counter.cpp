#include "hamflow/detail/verify/oscillation_counter.hpp"

#include <algorithm>

namespace hamflow {

namespace {
// A sample at a random place meets a peak with a probability equal to the part of the period that the peak lasts. If
// samples are 16 times as many as needed to meet one on average (32 for a sine), all of them miss the peak once in 10^7
// cases.
constexpr double samples_per_certain_turn = 16;
}  // namespace

void OscillationCounter::look(std::int64_t step, double x) {
  apart_ = step - last_sample_step_;
  last_sample_step_ = step;
  if (counted_range_ < 0) {
    least_ = most_ = extreme_ = x;
    at_ = step;
    counted_range_ = 0;
    return;
  }
  least_ = std::min(least_, x);
  most_ = std::max(most_, x);
  const double range = most_ - least_;
  if (range > 2 * counted_range_) {
    counted_range_ = range;
    earlier_turns_ += turns_;
    turns_ = 0;
    longest_gap_ = shortest_peak_ = 0;
    later_turns_ = 0;
    direction_ = x == most_ ? 1 : -1;
    extreme_ = x;
    at_ = step;
    return;
  }
  if (direction_ * (x - extreme_) >= 0) {
    extreme_ = x;
    at_ = step;
  } else if (direction_ * (extreme_ - x) >= range / 2) {
    turn(step);
    direction_ = -direction_;
    extreme_ = x;
    at_ = step;
  }
}

void OscillationCounter::turn(std::int64_t step) {
  // On an orbit whose axis rotates, a coordinate widens from turn to turn. Therefore a doubling of the range after a
  // whole period is measured against the range at the latest turn.
  if (turns_ >= 2) counted_range_ = most_ - least_;
  const std::int64_t gap = at_ - latest_turn_;
  const std::int64_t stay = step - recognised_at_;
  latest_turn_ = at_;
  recognised_at_ = step;
  if (turns_ > 0) longest_gap_ = std::max(longest_gap_, gap);
  if (turns_ >= enough_turns) {
    const double turns = static_cast<double>(gap) / half_period();
    // A gap that missed samples hardly explain (once in 3000 cases) counts as one slow oscillation.
    later_turns_ += static_cast<double>(gap) <= std::max(6 * half_period(), missed() / 2) ? turns : 1;
    return;
  }
  if (turns_ == 0) first_turn_ = at_;
  if (turns_ == 1 || (turns_ > 1 && stay < shortest_peak_)) shortest_peak_ = stay;
  last_turn_ = at_;
  ++turns_;
}

/// Returns the time for which samples may show no turn although the oscillation continues; 0: no turn can be missed.
double OscillationCounter::missed() const {
  const double apart = static_cast<double>(apart_);
  const double stay = static_cast<double>(shortest_peak_);
  return 2 * apart > stay ? samples_per_certain_turn * apart * 2 * half_period() / stay : 0;
}

std::optional<OscillationCounter::Seen> OscillationCounter::seen(std::int64_t steps_taken) const {
  if (turns_ == 0) return std::nullopt;
  if (turns_ == 1) return Seen{0.5, false, latest_turn_};
  const auto steps_since_turn = static_cast<double>(steps_taken - latest_turn_);
  const bool is_over = steps_since_turn > std::max(6 * static_cast<double>(longest_gap_), missed());
  // Before the first turn and after the last one there is at most half a period, unless turns may have been missed.
  const double begun = static_cast<double>(first_turn_) / half_period();
  const double before = earlier_turns_ > 0 ? begun : std::min(begun, 1.0);
  const double ended = steps_since_turn / half_period();
  const double after = is_over ? 0 : steps_since_turn <= missed() / 2 ? ended : std::min(ended, 1.0);
  const double half_periods = before + static_cast<double>(turns_ - 1) + later_turns_ + after;
  return Seen{half_periods / 2, is_over, latest_turn_};
}

std::optional<double> OscillationCounter::period(std::int64_t steps_taken) const {
  if (turns_ == 0) return std::nullopt;
  if (turns_ == 1) return 2 * static_cast<double>(steps_taken);
  return 2 * static_cast<double>(last_turn_ - first_turn_) / static_cast<double>(turns_ - 1);
}

}  // namespace hamflow
