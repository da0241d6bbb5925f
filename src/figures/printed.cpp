#include "printed.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_set>
#include <utility>

namespace hamflow::figures {

namespace {

/// A point in units of pixels of the box.
struct Pixel {
  double x = 0;
  double y = 0;
};

/// Returns the printed positions of the points of a curve; not finite if an axis has no position for them.
std::vector<Pixel> pixels_of(const Panel& panel, const Curve& curve, const PrintedBox& box) {
  const double across = box.width / box.pixel / (panel.x.high - panel.x.low);
  const double up = box.height / box.pixel / (panel.y.high - panel.y.low);
  std::vector<Pixel> pixels(curve.x.size());
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    pixels[k] = {across * (panel.x.place(curve.x[k]) - panel.x.low), up * (panel.y.place(curve.y[k]) - panel.y.low)};
  }
  return pixels;
}

bool is_finite(Pixel a) { return std::isfinite(a.x) && std::isfinite(a.y); }

using Places = std::vector<std::size_t>;  // indices of points of a curve, in order

/// Keeps, of successive points in one column of pixels, the first, the lowest, the highest and the last.
Places one_in_a_column(const std::vector<Pixel>& pixels, std::size_t begin, std::size_t end) {
  Places kept;
  for (std::size_t k = begin; k < end;) {
    const double column = std::floor(pixels[k].x);
    std::size_t low = k;
    std::size_t high = k;
    std::size_t next = k;
    for (; next < end && std::floor(pixels[next].x) == column; ++next) {
      if (pixels[next].y < pixels[low].y) low = next;
      if (pixels[next].y > pixels[high].y) high = next;
    }
    for (const std::size_t each : {k, std::min(low, high), std::max(low, high), next - 1}) {
      if (kept.empty() || kept.back() != each) kept.push_back(each);
    }
    k = next;
  }
  return kept;
}

double distance_from_chord(Pixel point, Pixel a, Pixel b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double square = dx * dx + dy * dy;
  const double part = square > 0 ? std::clamp(((point.x - a.x) * dx + (point.y - a.y) * dy) / square, 0.0, 1.0) : 0.0;
  return std::hypot(point.x - a.x - part * dx, point.y - a.y - part * dy);
}

/// Removes points within a tenth of a pixel of the chord over them.
Places without_straight_parts(const std::vector<Pixel>& pixels, const Places& places) {
  constexpr double tolerance = 0.1;
  constexpr std::size_t longest = 64;  // points below one chord; bounds the work
  if (places.size() < 3) return places;
  Places kept{places.front()};
  std::size_t from = 0;
  for (std::size_t to = 2; to < places.size(); ++to) {
    bool is_straight = to - from <= longest;
    for (std::size_t k = from + 1; k < to && is_straight; ++k) {
      is_straight = distance_from_chord(pixels[places[k]], pixels[places[from]], pixels[places[to]]) <= tolerance;
    }
    if (is_straight) continue;
    from = to - 1;
    kept.push_back(places[from]);
  }
  kept.push_back(places.back());
  return kept;
}

/// Counts how often a path enters each pixel of the box.
class Coverage {
 public:
  explicit Coverage(const PrintedBox& box)
      : wide_(static_cast<std::size_t>(box.width / box.pixel) + 1),
        high_(static_cast<std::size_t>(box.height / box.pixel) + 1),
        entries_(wide_ * high_) {}

  /// Pixels that a segment enters, without its first one.
  struct Entered {
    std::size_t pixels = 0;
    std::size_t empty = 0;  // number of those that were empty before
  };
  Entered add(Pixel a, Pixel b) {
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (!(length < 1e6)) return {1, 1};
    const auto steps = static_cast<std::size_t>(2 * length) + 1;
    Entered entered;
    std::size_t before = place(a);
    for (std::size_t s = 1; s <= steps; ++s) {
      const double part = static_cast<double>(s) / static_cast<double>(steps);
      const std::size_t here = place({a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)});
      if (here == before) continue;
      before = here;
      if (here == nowhere) continue;
      ++entered.pixels;
      if (entries_[here]++ == 0) ++entered.empty;
    }
    return entered;
  }

  /// Number of pixels that were entered.
  std::size_t pixels() const {
    return static_cast<std::size_t>(
        std::count_if(entries_.begin(), entries_.end(), [](std::uint32_t n) { return n > 0; }));
  }

  /// Returns whether a fifth of the path lies in an area without gaps that is wider than lines are.
  bool fills_an_area() const {
    constexpr std::size_t around = 2;
    std::size_t entered = 0;
    std::size_t inside = 0;
    for (std::size_t j = 0; j < high_; ++j) {
      for (std::size_t i = 0; i < wide_; ++i) {
        if (entries_[j * wide_ + i] == 0) continue;
        ++entered;
        if (i < around || j < around || i + around >= wide_ || j + around >= high_) continue;
        std::size_t gaps = 0;
        for (std::size_t y = j - around; y <= j + around; ++y) {
          for (std::size_t x = i - around; x <= i + around; ++x) gaps += entries_[y * wide_ + x] == 0 ? 1 : 0;
        }
        if (gaps <= 2) ++inside;
      }
    }
    return 5 * inside > entered;
  }

 private:
  static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);
  std::size_t place(Pixel a) const {
    if (!(a.x >= 0 && a.y >= 0 && a.x < static_cast<double>(wide_) && a.y < static_cast<double>(high_))) return nowhere;
    return static_cast<std::size_t>(a.y) * wide_ + static_cast<std::size_t>(a.x);
  }

  std::size_t wide_;
  std::size_t high_;
  std::vector<std::uint32_t> entries_;
};

Curve points_of(const Curve& curve, const Places& places) {
  Curve part;
  for (const std::size_t k : places) part.add(curve.x[k], curve.y[k]);
  return part;
}

/// Returns stretches of finite points, without points on straight parts.
/// @param columns whether points in one column of pixels fill an area, as for a curve over time, but not for a path
std::vector<Places> branches_of(const std::vector<Pixel>& pixels, bool columns) {
  std::vector<Places> branches;
  for (std::size_t begin = 0; begin < pixels.size();) {
    std::size_t end = begin;
    while (end < pixels.size() && is_finite(pixels[end])) ++end;
    if (end > begin) {
      Places all(end - begin);
      std::iota(all.begin(), all.end(), begin);
      branches.push_back(without_straight_parts(pixels, columns ? one_in_a_column(pixels, begin, end) : all));
    }
    begin = end + 1;
  }
  return branches;
}

Curve joined_branches(const Curve& curve, const std::vector<Places>& branches) {
  Curve result;
  for (const Places& branch : branches) {
    result.lift();
    for (const std::size_t k : branch) result.add(curve.x[k], curve.y[k]);
  }
  return result;
}

/// Returns the beginning of a path that enters at most `most` pixels.
Curve beginning(const Curve& curve, const std::vector<Pixel>& pixels, const std::vector<Places>& branches,
                const PrintedBox& box, std::size_t most) {
  Coverage coverage(box);
  Curve result;
  std::size_t entered = 0;
  for (const Places& branch : branches) {
    result.lift();
    for (std::size_t k = 0; k < branch.size(); ++k) {
      if (k > 0) entered += coverage.add(pixels[branch[k - 1]], pixels[branch[k]]).pixels;
      if (entered > most) return result;
      result.add(curve.x[branch[k]], curve.y[branch[k]]);
    }
  }
  return result;
}

/// Removes the segments that only run over pixels that already have ink.
Curve without_repeated_ink(const Curve& curve, const std::vector<Pixel>& pixels, const std::vector<Places>& branches,
                           const PrintedBox& box) {
  Coverage coverage(box);
  Curve result;
  for (const Places& branch : branches) {
    result.lift();
    if (branch.size() < 2) result.add(curve.x[branch[0]], curve.y[branch[0]]);
    bool is_down = false;
    for (std::size_t k = 1; k < branch.size(); ++k) {
      const Coverage::Entered entered = coverage.add(pixels[branch[k - 1]], pixels[branch[k]]);
      const bool is_end = result.x.empty() || k + 1 == branch.size();  // the first and the last point are kept
      // a segment within one pixel does not change whether the pen is down
      if (entered.pixels == 0 && !is_end) continue;
      if (entered.empty == 0 && !is_end) {
        if (is_down) result.lift();
        is_down = false;
        continue;
      }
      if (!is_down) result.add(curve.x[branch[k - 1]], curve.y[branch[k - 1]]);
      result.add(curve.x[branch[k]], curve.y[branch[k]]);
      is_down = true;
    }
  }
  return result;
}

/// Keeps one dot for each square of half a pixel.
Curve separate_dots(const Curve& curve, const std::vector<Pixel>& pixels) {
  std::unordered_set<std::uint64_t> taken;
  Places kept;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    if (!is_finite(pixels[k])) continue;
    const auto half = [](double x) {
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::clamp(std::floor(2 * x), -1e6, 1e6)));
    };
    const std::uint64_t place = (std::uint64_t{half(pixels[k].x)} << 32U) | half(pixels[k].y);
    if (taken.insert(place).second) kept.push_back(k);
  }
  return points_of(curve, kept);
}

}  // namespace

std::vector<Series> printed(const Panel& panel, Series series, const PrintedBox& box) {
  const bool is_line = series.ink == Ink::line || series.ink == Ink::exact || series.ink == Ink::level;
  const bool are_dots = series.ink == Ink::dots || series.ink == Ink::fine_dots;
  if (!is_line && !are_dots && series.ink != Ink::path) return {series};
  const std::vector<Pixel> pixels = pixels_of(panel, series.curve, box);
  if (are_dots) {
    series.curve = separate_dots(series.curve, pixels);
    return {series};
  }
  const std::vector<Places> branches = branches_of(pixels, series.ink == Ink::line);
  if (series.ink != Ink::path) {
    series.curve = joined_branches(series.curve, branches);
    return {series};
  }
  Coverage coverage(box);
  for (const Places& branch : branches) {
    for (std::size_t k = 1; k < branch.size(); ++k) coverage.add(pixels[branch[k - 1]], pixels[branch[k]]);
  }
  std::size_t points = 0;
  for (const Places& branch : branches) points += branch.size();
  constexpr std::size_t few = 1000;  // short paths are kept whole, because a path drawn once may have gaps of a pixel
  if (points <= few) {
    series.curve = joined_branches(series.curve, branches);
    return {series};
  }
  Series once = series;
  once.curve = without_repeated_ink(series.curve, pixels, branches, box);
  if (!coverage.fills_an_area()) return {once};
  constexpr double tint = 0.25;
  constexpr std::size_t one_of = 8;  // one pixel in this many has ink of the line
  once.opacity = tint;
  once.name.clear();
  series.curve = beginning(series.curve, pixels, branches, box, coverage.pixels() / one_of);
  return {once, series};
}

}  // namespace hamflow::figures
