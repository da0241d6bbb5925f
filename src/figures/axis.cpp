#include "axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hamflow::figures {

namespace {
constexpr double resolvable = 1e-5;  // a shorter range, relative to the numbers, has unreadable labels

int decimals_of(double step) {
  // The small shift keeps a step of 0.1 from counting as 0.0999...
  return std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
}

bool fits(const Axis& axis, TickRoom room) {
  const double count = std::floor(axis.high / axis.step) - std::ceil(axis.low / axis.step) + 1;
  if (count > 3 * static_cast<double>(room.ticks)) return false;  // not worth the labels
  const std::size_t ticks = axis.ticks().size();
  return ticks <= room.ticks && ticks * (axis.widest_label() + 1) <= room.characters;
}
}  // namespace

void Extent::include(double x) {
  if (!std::isfinite(x)) return;
  low = std::min(low, x);
  high = std::max(high, x);
}

void Extent::include(std::span<const double> xs) {
  for (const double x : xs) include(x);
}

double Extent::largest() const { return empty() ? 0 : std::max(std::abs(low), std::abs(high)); }

int common_exponent(double largest) {
  if (!(largest > 0) || (largest >= 0.99e-2 && largest < 1e4)) return 0;
  return static_cast<int>(std::floor(std::log10(largest) + 0.02));  // 9.99e5 belongs to 1e6
}

double scaled(double x, int exponent) {
  const int half = exponent / 2;  // 10^308 and 10^-308 both have to come out right
  return x / std::pow(10.0, half) / std::pow(10.0, exponent - half);
}

std::vector<std::pair<double, std::string>> Axis::ticks() const {
  std::vector<std::pair<double, std::string>> result;
  const int decimals = decimals_of(step);
  const double slack = 1e-9 * (high - low);
  for (double n = std::ceil((low - slack) / step); n * step <= high + slack && result.size() < 50; n += 1) {
    std::string label = fmt::format("{:.{}f}", std::abs(n) * step, decimals);
    if (n < 0) label.insert(0, "\u2212");
    result.emplace_back(n * step, label);
  }
  return result;
}

std::size_t Axis::widest_label() const {
  std::size_t widest = 1;
  for (const auto& [at, label] : ticks()) {
    widest = std::max(widest, at < 0 ? label.size() - 2 : label.size());  // the minus sign takes three bytes
  }
  return widest;
}

Axis fit_axis(const Extent& extent, double padding, TickRoom room) {
  if (extent.empty()) return plain_axis(-1, 1, room);
  const int exponent = common_exponent(extent.largest());
  const double low = scaled(extent.low, exponent);
  const double high = scaled(extent.high, exponent);
  const double size = std::max(std::abs(low), std::abs(high));
  double margin = padding * (high - low);
  if (high - low <= resolvable * size) margin = 0.5 * size;
  if (!(size > 0)) margin = 1;
  Axis axis = plain_axis(low - margin, high + margin, room);
  axis.exponent = exponent;
  return axis;
}

Axis plain_axis(double low, double high, TickRoom room) {
  const int first = static_cast<int>(std::floor(std::log10(high - low))) - 2;
  Axis axis{low, high};
  for (int power = first;; ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      axis.step = power < 0 ? digit / std::pow(10.0, -power) : digit * std::pow(10.0, power);
      if (!fits(axis, room)) continue;
      Axis finer = axis;
      finer.step *= 0.8;  // 4 in place of 5, where 5 leaves one or two ticks
      return digit == 5 && axis.ticks().size() < 3 && fits(finer, room) ? finer : axis;
    }
  }
}

}  // namespace hamflow::figures
