#include "outer_root.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "hamflow/numerics/root.hpp"

namespace hamflow {

namespace {

constexpr int too_many = 4;  // extrema among eight points of a scan; more may be hidden between the points

struct Point {
  double x;
  double value;
};

/// Points of the scan from the outside inwards, for the largest zero, without values that are not finite.
std::vector<Point> scanned(const std::function<double(double)>& f) {
  constexpr int far_octaves = 100;
  constexpr int near_octaves = 20;
  std::vector<double> magnitudes;
  for (int octave = far_octaves - 1; octave >= -far_octaves; --octave) {
    const int parts = octave < near_octaves && octave >= -near_octaves ? 128 : 4;
    for (int i = parts; i > 0; --i) magnitudes.push_back(exp2(octave + static_cast<double>(i) / parts));
  }
  std::vector<Point> all;
  const auto look = [&](double x) {
    const double value = f(x);
    if (std::isfinite(value)) all.push_back({x, value});
  };
  for (auto x = magnitudes.begin(); x != magnitudes.end(); ++x) look(*x);
  look(0);
  for (auto x = magnitudes.rbegin(); x != magnitudes.rend(); ++x) look(-*x);
  return all;
}

/// Whether f has an extremum at a point that may reach 0.
bool turns(const Point& outer, const Point& here, const Point& inner) {
  const double before = here.value - outer.value;
  const double after = inner.value - here.value;
  const double least = std::min({std::abs(outer.value), std::abs(here.value), std::abs(inner.value)});
  return before * after < 0 && std::min(std::abs(before), std::abs(after)) >= least / 4;
}

/// The minimum of f in an interval; f is positive at its ends.
Point least_between(const std::function<double(double)>& f, double a, double b) {
  std::uintmax_t passes = 200;
  const auto [x, value] =
      boost::math::tools::brent_find_minima(f, a, b, std::numeric_limits<double>::digits / 2, passes);
  return {x, value};
}

/// The outermost zero between x and a point of the scan. The interval is searched on finer and finer scales, because an
/// oscillating function has several zeros. nullopt if the search finds more and more zeros.
std::optional<double> outermost(const std::function<double(double)>& f, double x, const Point& outer,
                                const std::function<bool(double)>& is_zero) {
  constexpr int scales = 16;
  constexpr int parts = 64;
  const auto next = [&](double from) -> std::optional<double> {
    for (int scale = 0; scale < scales; ++scale) {
      const double width = std::ldexp(outer.x - from, -scale);
      Point last = {from + width, f(from + width)};
      for (int i = parts - 1; i > 0; --i) {
        const Point here = {from + width * i / parts, f(from + width * i / parts)};
        if (here.x <= from) break;
        if (std::isfinite(last.value) && std::isfinite(here.value) && here.value * outer.value < 0 &&
            last.value * outer.value > 0) {
          const double root = bracketed_root(f, here.x, last.x, here.value, last.value);
          if (root > from && is_zero(root)) return root;
        }
        last = here;
      }
    }
    return std::nullopt;
  };
  constexpr int passes = 32;
  for (int i = 0; i < passes; ++i) {
    const auto further = next(x);
    if (!further) return x;
    x = *further;
  }
  return std::nullopt;
}

/// The point outside of point i from which on f keeps the sign of the point before i.
const Point& one_sided(const std::vector<Point>& points, std::size_t i) {
  constexpr std::size_t reach = 4;
  std::size_t k = i - 1;
  while (k > 0 && i - k < reach && points[k - 1].value * points[i - 1].value > 0) --k;
  return points[k];
}

/// A zero x next to point i of the scan, or one further out. If f has extrema at almost every point there, the zero was
/// found by chance and is not known to be the last.
OuterRoot settled(const std::function<double(double)>& f, const std::vector<Point>& points, std::size_t i, double x,
                  const std::function<bool(double)>& is_zero) {
  constexpr std::size_t reach = 8;
  int count = 0;
  for (std::size_t k = i; k + 1 < points.size() && k < i + reach; ++k) {
    count += turns(points[k - 1], points[k], points[k + 1]) ? 1 : 0;
  }
  const auto last = outermost(f, x, one_sided(points, i), is_zero);
  if (count >= too_many || !last) return {.x = std::nullopt, .is_decided = false};
  return {.x = last};
}

}  // namespace

OuterRoot outer_root(const std::function<double(double)>& f, bool largest, const std::function<bool(double)>& is_zero) {
  if (!largest) {
    OuterRoot mirrored = outer_root([&](double x) { return f(-x); }, true, [&](double x) { return is_zero(-x); });
    if (mirrored.x) mirrored.x = -*mirrored.x;
    return mirrored;
  }
  const std::vector<Point> points = scanned(f);
  constexpr std::size_t window = 8;
  std::vector<bool> turned(points.size(), false);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& here = points[i];
    if (i > 0 && i + 1 < points.size()) turned[i] = turns(points[i - 1], here, points[i + 1]);
    const auto end = turned.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    const auto begin = end - static_cast<std::ptrdiff_t>(std::min(i + 1, window));
    if (std::count(begin, end, true) >= too_many) return {.x = std::nullopt, .is_decided = false};
    if (here.value == 0) {
      if (i == 0) return {.x = std::nullopt, .is_decided = false};
      return {.x = here.x};
    }
    if (i == 0) continue;
    const Point& outer = points[i - 1];
    if ((here.value > 0) != (outer.value > 0)) {
      const double x = bracketed_root(f, here.x, outer.x, here.value, outer.value);
      if (is_zero(x)) return settled(f, points, i, x, is_zero);
      // A jump or a pole changes the sign without a zero.
      continue;
    }
    if (i + 1 == points.size()) break;
    // f may reach 0 between three points of one sign if the middle one is closest to 0.
    const Point& inner = points[i + 1];
    const double sign = here.value > 0 ? 1 : -1;
    if (!(sign * here.value < sign * outer.value && sign * here.value <= sign * inner.value)) continue;
    const Point dip = least_between([&](double x) { return sign * f(x); }, inner.x, outer.x);
    if (dip.value < 0) {
      const double x = bracketed_root(f, dip.x, outer.x, sign * dip.value, outer.value);
      if (is_zero(x)) return settled(f, points, i, x, is_zero);
    } else if (is_zero(dip.x)) {
      return settled(f, points, i, dip.x, is_zero);
    }
  }
  return {};
}

}  // namespace hamflow
