// How often something has turned back: the oscillations that a run has seen, from its samples alone.
#pragma once

#include <cstdint>
#include <optional>

namespace hamflow {

/// One quantity, watched at samples of increasing steps. A turn is a change of direction by at least half of the range
/// covered so far: small oscillations on top of a slow one do not count, and neither does what only grows, such as an
/// angle that is not wrapped. Where the range doubles, what was counted before was small beside it, and counting begins
/// again. After enough turns the period is known and kept, since samples of a long run may be further apart than it.
class Swings {
 public:
  /// What was seen of an oscillation up to the end of a run.
  struct Seen {
    double periods = 0;    // half of one after a single turn
    bool is_over = false;  // nothing has turned back for longer than three of its periods
    std::int64_t last_turn = 0;
  };
  void look(std::int64_t step, double x);
  double range() const { return most_ - least_; }
  /// Turns that were seen, and between them those that samples so far apart miss; beyond the last one no more than what
  /// passes until the next has to be seen. None: nothing has turned back since the range doubled last.
  std::optional<Seen> seen(std::int64_t steps_taken) const;
  /// In steps: twice the mean time between turns. After a single turn it is known only to be long: twice the run.
  /// None: nothing has turned back since the range doubled last.
  std::optional<double> period(std::int64_t steps_taken) const;
  /// Half of the turns that were counted at smaller ranges: what was seen of an oscillation that grows or drifts away.
  double earlier_periods() const { return 0.5 * static_cast<double>(earlier_turns_); }

  template <class Archive>
  void archive(Archive& ar) {
    ar(least_, most_, counted_range_, extreme_, at_, first_turn_, last_turn_, turns_, earlier_turns_, direction_,
       looked_, apart_, noticed_, latest_turn_, longest_gap_, shortest_stay_, later_turns_);
  }

 private:
  void turn(std::int64_t step);
  double half_period() const { return static_cast<double>(last_turn_ - first_turn_) / static_cast<double>(turns_ - 1); }
  double missed() const;
  static constexpr std::int64_t enough_turns = 33;  // sixteen periods
  double least_ = 0;
  double most_ = 0;
  double counted_range_ = -1;  // when counting began; negative: nothing seen yet
  double extreme_ = 0;         // the furthest since the last turn
  std::int64_t at_ = 0;        // its step
  std::int64_t first_turn_ = 0;
  std::int64_t last_turn_ = 0;
  std::int64_t turns_ = 0;
  std::int64_t earlier_turns_ = 0;
  int direction_ = 0;
  std::int64_t looked_ = 0;         // the step of the last sample
  std::int64_t apart_ = 0;          // how far it was from the one before
  std::int64_t noticed_ = 0;        // the sample that showed the last turn
  std::int64_t latest_turn_ = 0;    // also beyond those that the period is taken from
  std::int64_t longest_gap_ = 0;    // between turns
  std::int64_t shortest_stay_ = 0;  // from where one turn showed to where the next did: how long a peak lasts
  double later_turns_ = 0;          // beyond those that the period is taken from, with those that were missed
};

}  // namespace hamflow
