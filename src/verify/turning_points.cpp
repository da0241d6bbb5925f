#include "hamflow/detail/verify/turning_points.hpp"

#include <algorithm>
#include <cmath>

namespace hamflow {

namespace {

/// Returns the vertex of a parabola through three neighbours.
double vertex(const std::vector<double>& x, std::size_t at) {
  const double curvature = x[at - 1] - 2 * x[at] + x[at + 1];
  const double shift = curvature == 0 ? 0 : (x[at - 1] - x[at + 1]) / (2 * curvature);
  return static_cast<double>(at) + std::clamp(shift, -0.5, 0.5);
}

/// Returns the places of alternating maxima and minima from which the series moved back by more than `noise`.
std::vector<double> turns(const std::vector<double>& x, double noise) {
  std::vector<double> places;
  int direction = 0;  // unknown
  std::size_t extreme = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    const double back = direction == 0 ? std::abs(x[i] - x[0]) : direction * (x[extreme] - x[i]);
    if (back > noise) {
      if (direction != 0) places.push_back(vertex(x, extreme));
      direction = x[i] > x[extreme] ? 1 : -1;
      extreme = i;
    } else if (direction * (x[i] - x[extreme]) > 0) {
      extreme = i;
    }
  }
  return places;
}

}  // namespace

std::optional<double> median_period(const std::vector<double>& series, double noise) {
  const std::vector<double> places = turns(series, noise);
  std::vector<double> periods;
  for (std::size_t i = 0; i + 2 < places.size(); ++i) periods.push_back(places[i + 2] - places[i]);
  if (periods.size() < TurningPointObserver::fewest_periods) return std::nullopt;
  std::sort(periods.begin(), periods.end());
  const std::size_t half = periods.size() / 2;
  return periods.size() % 2 == 1 ? periods[half] : (periods[half - 1] + periods[half]) / 2;
}

void TurningPointObserver::restart(std::int64_t step, double dt, bool active) {
  found_ = fastest();
  longest_ = longest_step();
  samples_.clear();
  first_ = step;
  last_ = step - 1;
  dt_ = dt;
  active_ = active;
}

double TurningPointObserver::longest_step() const {
  return last_ > first_ ? std::max(longest_, std::abs(dt_)) : longest_;
}

std::int64_t TurningPointObserver::next_due(std::int64_t step) const {
  if (!active_) return never;
  const std::int64_t since = std::max(step, last_ + 1) - first_;
  if (since <= window) return first_ + std::max<std::int64_t>(since, 0);
  std::int64_t begin = 2 * window;
  while (begin <= since - begin) begin *= 2;
  if (since < begin) return first_ + begin;
  if (since <= begin + window) return first_ + since;
  return begin > never / 4 ? never : first_ + 2 * begin;
}

Verdict TurningPointObserver::observe(const Frame& frame) {
  if (frame.step != last_ + 1) samples_.clear();
  last_ = frame.step;
  stride_ = (frame.q.size() + most_coordinates - 1) / most_coordinates;
  width_ = (frame.q.size() + stride_ - 1) / stride_;
  for (std::size_t i = 0; i < frame.q.size(); i += stride_) samples_.push_back(frame.q[i]);
  if (samples_.size() == width_ * (window + 1)) {
    found_ = fastest();
    samples_.clear();
  }
  return Verdict::go_on;
}

std::optional<FastestOscillation> TurningPointObserver::fastest() const {
  const auto now = in_window();
  if (!now || !found_) return now ? now : found_;
  return now->period / std::abs(now->dt) < found_->period / std::abs(found_->dt) ? now : found_;
}

std::optional<FastestOscillation> TurningPointObserver::in_window() const {
  const std::size_t rows = width_ == 0 ? 0 : samples_.size() / width_;
  if (rows < fewest_periods + 2) return std::nullopt;
  std::vector<std::vector<double>> series(width_, std::vector<double>(rows));
  std::vector<double> largest(width_, 0);
  double range = 0;  // range of the coordinate that moves most
  for (std::size_t j = 0; j < width_; ++j) {
    for (std::size_t i = 0; i < rows; ++i) {
      series[j][i] = samples_[i * width_ + j];
      largest[j] = std::max(largest[j], std::abs(series[j][i]));
    }
    const auto [low, high] = std::minmax_element(series[j].begin(), series[j].end());
    range = std::max(range, *high - *low);
  }
  if (!std::isfinite(range)) return std::nullopt;
  std::optional<FastestOscillation> best;
  for (std::size_t j = 0; j < width_; ++j) {
    // The noise that rounding or a loose tolerance causes in a coordinate at rest is not an oscillation.
    const auto steps = median_period(series[j], std::max(1e-6 * range, 1e-9 * largest[j]));
    if (steps && (!best || *steps * std::abs(dt_) < best->period)) best = {*steps * std::abs(dt_), dt_, j * stride_};
  }
  return best;
}

}  // namespace hamflow
