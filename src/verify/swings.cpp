#include "hamflow/verify/swings.hpp"

#include <algorithm>

namespace hamflow {

void Swings::look(std::int64_t step, double x) {
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
    direction_ = x == most_ ? 1 : -1;
    extreme_ = x;
    at_ = step;
    return;
  }
  if (turns_ >= enough_turns) return;
  if (direction_ * (x - extreme_) >= 0) {
    extreme_ = x;
    at_ = step;
  } else if (direction_ * (extreme_ - x) >= range / 2) {
    if (turns_ == 0) first_turn_ = at_;
    last_turn_ = at_;
    ++turns_;
    direction_ = -direction_;
    extreme_ = x;
    at_ = step;
  }
}

std::optional<double> Swings::period(std::int64_t steps_taken) const {
  if (turns_ == 0) return std::nullopt;
  if (turns_ == 1) return 2 * static_cast<double>(steps_taken);
  return 2 * static_cast<double>(last_turn_ - first_turn_) / static_cast<double>(turns_ - 1);
}

}  // namespace hamflow
