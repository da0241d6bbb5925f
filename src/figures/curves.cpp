#include "hamflow/figures/curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "figure.hpp"

namespace hamflow::figures {

namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
}

void Curve::add(double x_value, double y_value) {
  x.push_back(x_value);
  y.push_back(y_value);
}

void Curve::lift() {
  if (!x.empty() && !std::isnan(x.back())) add(nan, nan);
}

bool is_polar(const FigureData& data) { return data.coordinates == std::vector<std::string>{"r", "phi"}; }

Curve polar_track(const FigureSamples& samples) {
  const Curve polar = finite_points(samples.q[0], samples.q[1]);
  Curve track;
  for (std::size_t k = 0; k < polar.x.size(); ++k) {
    track.add(polar.x[k] * std::cos(polar.y[k]), polar.x[k] * std::sin(polar.y[k]));
  }
  return track;
}

Curve orbit_track(const FigureData& data) {
  if (data.q.size() != 2) return {};
  return is_polar(data) ? polar_track(data) : finite_points(data.q[0], data.q[1]);
}

Curve finite_points(std::span<const double> x, std::span<const double> y, Gaps gaps) {
  Curve result;
  for (std::size_t k = 0; k < std::min(x.size(), y.size()); ++k) {
    if (std::isfinite(x[k]) && std::isfinite(y[k])) {
      result.add(x[k], y[k]);
    } else if (gaps == Gaps::kept) {
      result.lift();
    }
  }
  return result;
}

double path_length(const Curve& curve) {
  double length = 0;
  for (std::size_t k = 1; k < curve.x.size(); ++k) {
    length += std::hypot(curve.x[k] - curve.x[k - 1], curve.y[k] - curve.y[k - 1]);
  }
  return length;
}

Curve thin_out(const Curve& curve, std::size_t limit) {
  const std::size_t n = curve.x.size();
  if (n <= limit) return curve;
  const auto pick = [&](const std::function<std::size_t(std::size_t)>& place) {
    Curve result;
    for (std::size_t k = 0; k < limit; ++k) result.add(curve.x[place(k)], curve.y[place(k)]);
    return result;
  };
  Curve regular = pick([&](std::size_t k) { return k * (n - 1) / (limit - 1); });
  if (path_length(regular) >= 0.8 * path_length(curve)) return regular;
  return pick([&](std::size_t k) {
    const std::size_t begin = k * n / limit;
    const std::size_t length = (k + 1) * n / limit - begin;
    const double part = std::fmod(static_cast<double>(k) / std::numbers::phi, 1.0);  // fills [0, 1) evenly
    return begin + static_cast<std::size_t>(part * static_cast<double>(length));
  });
}

Band envelope(const Curve& curve, std::size_t columns) {
  Extent range;
  range.include(curve.x);
  Band band;
  if (range.empty() || !(range.high > range.low)) return band;
  constexpr double inf = std::numeric_limits<double>::infinity();
  std::vector<double> low(columns, inf);
  std::vector<double> high(columns, -inf);
  const double wide = static_cast<double>(columns) / (range.high - range.low);
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    if (!std::isfinite(curve.x[k]) || !std::isfinite(curve.y[k])) continue;
    const auto c = std::min(columns - 1, static_cast<std::size_t>((curve.x[k] - range.low) * wide));
    low[c] = std::min(low[c], curve.y[k]);
    high[c] = std::max(high[c], curve.y[k]);
  }
  for (std::size_t c = 0; c < columns; ++c) {
    if (low[c] > high[c]) continue;
    band.x.push_back(range.low + (static_cast<double>(c) + 0.5) / wide);
    band.low.push_back(low[c]);
    band.high.push_back(high[c]);
  }
  return band;
}

bool follows_path(const Curve& curve) {
  const std::size_t n = curve.x.size();
  if (n < 8) return false;
  std::size_t gentle = 0;
  for (std::size_t k = 2; k < n; ++k) {
    const double before = std::atan2(curve.y[k - 1] - curve.y[k - 2], curve.x[k - 1] - curve.x[k - 2]);
    const double after = std::atan2(curve.y[k] - curve.y[k - 1], curve.x[k] - curve.x[k - 1]);
    if (std::abs(std::remainder(after - before, 2 * std::numbers::pi)) < 0.5) ++gentle;
  }
  return 10 * gentle > 9 * (n - 2);
}

}  // namespace hamflow::figures
