// Turns of coordinates: is a step short beside the fastest oscillation that a run shows?
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hamflow/run/observer.hpp"

namespace hamflow {

/// The fastest oscillation seen.
struct FastestTurns {
  double period = 0;             // time
  double dt = 0;                 // the step length with which it was seen
  std::uint64_t coordinate = 0;  // from 0

  template <class Archive>
  void archive(Archive& ar) {
    ar(period, dt, coordinate);
  }
};

/// Looks at the coordinates at every step of a window of 64 steps, at the start and from 128, 256, 512, ... steps on: a
/// run of 10^9 steps is interrupted 1600 times. A window of 64 steps shows at least six periods of whatever is too fast
/// for ten steps a period; slower oscillations are of no interest here. Where the windows are depends on no end of the
/// run, so that a run that is resumed and made longer sees what one in a single piece sees.
class TurnWatch final : public Observer {
 public:
  static constexpr std::int64_t window = 64;
  static constexpr std::size_t fewest_periods = 4;      // in a window, to speak of an oscillation
  static constexpr std::size_t most_coordinates = 512;  // of more every second, third, ... one is watched

  /// @param active false: nothing is watched, as with methods whose steps have sub-steps of their own
  explicit TurnWatch(double dt, bool active = true) : dt_(dt), active_(active) {}

  bool is_active() const { return active_; }
  double step_length() const { return dt_; }
  /// The longest step taken, without its sign; 0 before the first.
  double longest_step() const;
  /// From this step on with another step length; what was seen before stays.
  void restart(std::int64_t step, double dt, bool active);
  /// The fewest steps a period; none where no coordinate was seen to oscillate in 64 steps.
  std::optional<FastestTurns> fastest() const;

  std::int64_t next_due(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;
  void archive(Writer& ar) override { fields(ar); }
  void archive(Reader& ar) override { fields(ar); }

 private:
  template <class Archive>
  void fields(Archive& ar) {
    ar(longest_, first_, last_, stride_, width_, samples_, found_);
  }
  std::optional<FastestTurns> in_window() const;

  double dt_;
  bool active_;
  double longest_ = 0;           // of the step lengths before the present one
  std::int64_t first_ = 0;       // the step from which windows are counted
  std::int64_t last_ = -1;       // the last one seen
  std::uint64_t stride_ = 1;     // from one coordinate watched to the next
  std::uint64_t width_ = 0;      // how many are
  std::vector<double> samples_;  // of the present window, step by step
  std::optional<FastestTurns> found_;
};

/// The median time from one turn of a series to the next but one, in samples; none with fewer than four such times.
/// Twice the mean of two neighbouring times between turns: an eccentric orbit turns unevenly.
/// @param noise a turn counts once the series has come back by more
std::optional<double> median_period(const std::vector<double>& series, double noise);

}  // namespace hamflow
