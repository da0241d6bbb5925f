// Counts the turning points of a quantity, and so its oscillations, from the samples of a run.
#pragma once

#include <cstdint>
#include <optional>

namespace hamflow {

/// Observes one quantity at samples of increasing steps. A change of direction counts as a turn if the quantity moves
/// back by at least half of the range covered so far. So small oscillations on top of a slow one are not counted, and a
/// quantity that only grows, such as an angle that is not wrapped, has no turns. When the range doubles, earlier turns
/// were comparatively small, and counting starts again. The period is fixed after enough turns, because later samples
/// of a long run may be further apart than one period.
class OscillationCounter {
 public:
  /// Oscillation until the end of a run.
  struct Seen {
    double periods = 0;    // number of periods; one half after a single turn
    bool is_over = false;  // no turn for longer than three periods
    std::int64_t last_turn = 0;
  };
  void look(std::int64_t step, double x);
  double range() const { return most_ - least_; }
  /// Returns the turns that were seen, plus an estimate of those that were missed between samples far apart. After the
  /// last turn, time counts only up to the moment at which the next one would have been seen. nullopt: no turn since
  /// the range last doubled.
  std::optional<Seen> seen(std::int64_t steps_taken) const;
  /// Returns the period in steps: twice the mean time between turns. After a single turn the period is only known to be
  /// long, and twice the length of the run is returned. nullopt: no turn since the range last doubled.
  std::optional<double> period(std::int64_t steps_taken) const;
  /// Returns half of the number of turns that were counted at smaller ranges, for an oscillation that grows or drifts
  /// away.
  double earlier_periods() const { return 0.5 * static_cast<double>(earlier_turns_); }

  template <class Archive>
  void archive(Archive& ar) {
    ar(least_, most_, counted_range_, extreme_, at_, first_turn_, last_turn_, turns_, earlier_turns_, direction_,
       last_sample_step_, apart_, recognised_at_, latest_turn_, longest_gap_, shortest_peak_, later_turns_);
  }

 private:
  void turn(std::int64_t step);
  double half_period() const { return static_cast<double>(last_turn_ - first_turn_) / static_cast<double>(turns_ - 1); }
  double missed() const;
  static constexpr std::int64_t enough_turns = 33;  // sixteen periods
  double least_ = 0;
  double most_ = 0;
  double counted_range_ = -1;  // range when counting began; negative: no sample yet
  double extreme_ = 0;         // extreme value since the last turn
  std::int64_t at_ = 0;        // step of extreme_
  std::int64_t first_turn_ = 0;
  std::int64_t last_turn_ = 0;
  std::int64_t turns_ = 0;
  std::int64_t earlier_turns_ = 0;
  int direction_ = 0;
  std::int64_t last_sample_step_ = 0;  // step of the last sample
  std::int64_t apart_ = 0;             // distance of the last two samples, in steps
  std::int64_t recognised_at_ = 0;     // sample at which the last turn was recognised
  std::int64_t latest_turn_ = 0;       // last turn, including turns that are not used for the period
  std::int64_t longest_gap_ = 0;       // longest time between turns
  // shortest time between the recognition of two turns, which is the duration of a peak
  std::int64_t shortest_peak_ = 0;
  double later_turns_ = 0;  // turns that are not used for the period, including missed ones
};

}  // namespace hamflow
