// Counts the turning points of a quantity, and so its oscillations, from the samples of a run.
#pragma once

#include <cstdint>
#include <optional>

namespace hamflow {

/// One quantity, observed at samples of increasing steps. A turn is a change of direction by at least half of the range
/// covered so far. So small oscillations on top of a slow one are not counted, and neither is a quantity that only
/// grows, such as an angle that is not wrapped. If the range doubles, earlier turns were small in comparison and
/// counting starts again. After enough turns the period is known and kept, since samples of a long run may be further
/// apart than it.
class Swings {
 public:
  /// The oscillation up to the end of a run.
  struct Seen {
    double periods = 0;    // one half after a single turn
    bool is_over = false;  // no turn for longer than three periods
    std::int64_t last_turn = 0;
  };
  void look(std::int64_t step, double x);
  double range() const { return most_ - least_; }
  /// The turns that were seen, with those between them that samples so far apart miss. After the last one at most the
  /// time is counted in which the next one must be seen. nullopt: no turn since the range doubled last.
  std::optional<Seen> seen(std::int64_t steps_taken) const;
  /// In steps: twice the mean time between turns. After a single turn it is only known to be long, and twice the run is
  /// returned. nullopt: no turn since the range doubled last.
  std::optional<double> period(std::int64_t steps_taken) const;
  /// Half of the turns that were counted at smaller ranges, for an oscillation that grows or drifts away.
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
  double counted_range_ = -1;  // the range when counting began; negative: no sample yet
  double extreme_ = 0;         // the extreme value since the last turn
  std::int64_t at_ = 0;        // its step
  std::int64_t first_turn_ = 0;
  std::int64_t last_turn_ = 0;
  std::int64_t turns_ = 0;
  std::int64_t earlier_turns_ = 0;
  int direction_ = 0;
  std::int64_t looked_ = 0;         // the step of the last sample
  std::int64_t apart_ = 0;          // distance of the last sample from the one before, in steps
  std::int64_t noticed_ = 0;        // the sample at which the last turn was recognised
  std::int64_t latest_turn_ = 0;    // including turns that are not used for the period
  std::int64_t longest_gap_ = 0;    // between turns
  std::int64_t shortest_stay_ = 0;  // shortest time between the recognition of two turns: the duration of a peak
  double later_turns_ = 0;          // turns that are not used for the period, including missed ones
};

}  // namespace hamflow
