// Observes turning points of coordinates, to check whether a step is short compared with the fastest oscillation of a
// run.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hamflow/run/observer.hpp"

namespace hamflow {

/// The fastest oscillation that was seen.
struct FastestOscillation {
  double period = 0;             // in units of time
  double dt = 0;                 // step size of the steps that showed the oscillation
  std::uint64_t coordinate = 0;  // index, counted from 0

  template <class Archive>
  void archive(Archive& ar) {
    ar(period, dt, coordinate);
  }
};

/// Observes the coordinates at every step of windows of 64 steps, which begin at the steps 0, 128, 256, 512, ...: a run
/// of 10^9 steps is interrupted 1600 times. A window shows at least six periods of an oscillation with fewer than ten
/// steps per period; slower oscillations do not matter here. The windows do not depend on the length of the run, so a
/// run that is resumed and prolonged sees the same as an uninterrupted one.
class TurningPointObserver final : public Observer {
 public:
  static constexpr std::int64_t window = 64;
  static constexpr std::size_t fewest_periods = 4;      // periods in a window that count as an oscillation
  static constexpr std::size_t most_coordinates = 512;  // if there are more, every second, third, ... is observed
  /// @param active false: observe nothing, for example for methods with sub-steps
  explicit TurningPointObserver(double dt, bool active = true) : dt_(dt), active_(active) {}

  bool is_active() const { return active_; }
  double step_length() const { return dt_; }
  /// Returns the absolute value of the longest step taken; 0 before the first step.
  double longest_step() const;
  /// Continues from this step with another step size, and keeps earlier results.
  void restart(std::int64_t step, double dt, bool active);
  /// Returns the oscillation with the fewest steps per period; nullopt if no coordinate oscillated within 64 steps.
  std::optional<FastestOscillation> fastest() const;

  std::int64_t next_due(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;
  void archive(Writer& ar) override { fields(ar); }
  void archive(Reader& ar) override { fields(ar); }

 private:
  template <class Archive>
  void fields(Archive& ar) {
    ar(longest_, first_, last_, stride_, width_, samples_, found_);
  }
  std::optional<FastestOscillation> in_window() const;

  double dt_;
  bool active_;
  double longest_ = 0;           // longest step before dt_ was last set
  std::int64_t first_ = 0;       // the step from which windows are counted
  std::int64_t last_ = -1;       // the last step observed
  std::uint64_t stride_ = 1;     // distance between observed coordinates
  std::uint64_t width_ = 0;      // number of observed coordinates
  std::vector<double> samples_;  // samples of the current window, step by step
  std::optional<FastestOscillation> found_;
};

/// Returns the median time from one turn of a series to the turn after the next, in samples; nullopt with fewer than
/// four such times. Two half periods are taken together, because those of an eccentric orbit are unequal.
/// @param noise a turn is counted if the series has moved back by more than this
std::optional<double> median_period(const std::vector<double>& series, double noise);

}  // namespace hamflow
