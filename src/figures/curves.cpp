#include "curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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

Curve orbit_track(const FigureData& data) {
  if (data.q.size() != 2) return {};
  if (!is_polar(data)) return finite_points(data.q[0], data.q[1]);
  const Curve polar = finite_points(data.q[0], data.q[1]);
  Curve track;
  for (std::size_t k = 0; k < polar.x.size(); ++k) {
    track.add(polar.x[k] * std::cos(polar.y[k]), polar.x[k] * std::sin(polar.y[k]));
  }
  return track;
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

Curve envelope(const Curve& curve, std::size_t stretches) {
  const std::size_t n = curve.x.size();
  if (n <= 4 * stretches) return curve;
  Curve result;
  for (std::size_t s = 0; s < stretches; ++s) {
    const std::size_t begin = s * n / stretches;
    const std::size_t end = (s + 1) * n / stretches;
    std::size_t least = begin;
    std::size_t most = begin;
    bool gap = false;
    for (std::size_t k = begin; k < end; ++k) {
      gap = gap || std::isnan(curve.y[k]);
      if (curve.y[k] < curve.y[least] || std::isnan(curve.y[least])) least = k;
      if (curve.y[k] > curve.y[most] || std::isnan(curve.y[most])) most = k;
    }
    std::array<std::size_t, 4> kept{begin, least, most, end - 1};
    std::sort(kept.begin(), kept.end());
    for (std::size_t k = 0; k < kept.size(); ++k) {
      if ((k == 0 || kept[k] != kept[k - 1]) && !std::isnan(curve.y[kept[k]])) {
        result.add(curve.x[kept[k]], curve.y[kept[k]]);
      }
    }
    if (gap) result.lift();
  }
  return result;
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
