#include "hamflow/numerics/outer_root.hpp"

#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "hamflow/numerics/root.hpp"

namespace hamflow {

namespace {

struct Point {
  double x;
  double value;
};

/// From the outside inwards, for the largest zero; what is not finite is left out.
std::vector<Point> scanned(const std::function<double(double)>& f) {
  constexpr int octaves = 100;
  constexpr int parts = 4;
  std::vector<Point> all;
  const auto look = [&](double x) {
    const double value = f(x);
    if (std::isfinite(value)) all.push_back({x, value});
  };
  for (int i = octaves * parts; i >= -octaves * parts; --i) look(std::exp2(static_cast<double>(i) / parts));
  look(0);
  for (int i = -octaves * parts; i <= octaves * parts; ++i) look(-std::exp2(static_cast<double>(i) / parts));
  return all;
}

/// The point of an interval at which f, positive at its ends, is least.
Point least_between(const std::function<double(double)>& f, double a, double b) {
  std::uintmax_t passes = 200;
  const auto [x, value] =
      boost::math::tools::brent_find_minima(f, a, b, std::numeric_limits<double>::digits / 2, passes);
  return {x, value};
}

}  // namespace

std::optional<double> outer_root(const std::function<double(double)>& f, bool largest) {
  if (!largest) {
    const auto mirrored = outer_root([&](double x) { return f(-x); }, true);
    return mirrored ? std::optional(-*mirrored) : std::nullopt;
  }
  const std::vector<Point> points = scanned(f);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& here = points[i];
    if (here.value == 0) return here.x;
    if (i == 0) continue;
    const Point& outer = points[i - 1];
    if ((here.value > 0) != (outer.value > 0)) {
      return bracketed_root(f, here.x, outer.x, here.value, outer.value);
    }
    if (i + 1 == points.size()) break;
    // Between three points of one sign, of which the middle one is nearest to 0, f may reach it.
    const Point& inner = points[i + 1];
    const double sign = here.value > 0 ? 1 : -1;
    if (!(sign * here.value < sign * outer.value && sign * here.value <= sign * inner.value)) continue;
    const Point dip = least_between([&](double x) { return sign * f(x); }, inner.x, outer.x);
    if (dip.value < 0) return bracketed_root(f, dip.x, outer.x, sign * dip.value, outer.value);
    constexpr double touches = 64 * std::numeric_limits<double>::epsilon();
    if (dip.value <= touches * std::abs(outer.value)) return dip.x;
  }
  return std::nullopt;
}

}  // namespace hamflow
