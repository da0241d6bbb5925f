#include "hamflow/figures/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "text.hpp"

namespace hamflow::figures {

namespace {
constexpr std::size_t most_words = 48;  // the number of upright words that fit next to each other on a wide page

int decimals_of(double step) {
  // The small shift prevents a step of 0.1 from counting as 0.0999...
  return std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
}

std::vector<Tick> linear_ticks(const Axis& axis) {
  std::vector<Tick> result;
  const int decimals = decimals_of(axis.step);
  const double slack = 1e-9 * (axis.high - axis.low);
  for (double n = std::ceil((axis.low - slack) / axis.step); n * axis.step <= axis.high + slack && result.size() < 50;
       n += 1) {
    std::string label = n == 0 ? "0" : fmt::format("{:.{}f}", std::abs(n) * axis.step, decimals);
    if (n < 0) label.insert(0, "\u2212");
    result.push_back({n * axis.step, label});
  }
  return result;
}

/// Makes ticks at powers of ten, on long axes at every second or third. Minor ticks are at the other digits; on short
/// axes 2 and 5 have labels.
std::vector<Tick> logarithmic_ticks(const Axis& axis) {
  std::vector<Tick> result;
  const auto add = [&](double at, const std::string& label, bool minor) {
    if (at >= axis.low - 1e-9 && at <= axis.high + 1e-9) result.push_back({at, label, minor});
  };
  const double length = axis.high - axis.low;
  const int step = std::max(1, static_cast<int>(std::ceil(length / 7)));
  const bool is_short = length < 2.2;
  for (int k = static_cast<int>(std::floor(axis.low)) - 1; k <= static_cast<int>(std::ceil(axis.high)); ++k) {
    const bool major = k % step == 0;
    add(k, major ? power_of_ten(k) : "", !major);
    for (int digit = 2; digit <= 9 && step == 1; ++digit) {
      const bool labelled = is_short && (digit == 2 || digit == 5);
      add(k + std::log10(digit), labelled ? fmt::format("{}·{}", digit, power_of_ten(k)) : "", true);
    }
  }
  return result;
}

/// Makes ticks with words at 0, 1, 2, ...
std::vector<Tick> word_ticks(const Axis& axis) {
  std::vector<Tick> result;
  const std::size_t every = (axis.words.size() + most_words - 1) / most_words;
  for (std::size_t k = 0; k < axis.words.size(); ++k) {
    result.push_back({static_cast<double>(k), k % every == 0 ? axis.words[k] : ""});
  }
  return result;
}

bool fits(const Axis& axis, TickRoom room) {
  const double count = std::floor(axis.high / axis.step) - std::ceil(axis.low / axis.step) + 1;
  if (count > 3 * static_cast<double>(room.ticks)) return false;  // skips making labels that cannot fit
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

void Extent::include_positive(std::span<const double> xs) {
  for (const double x : xs) {
    if (x > 0) include(x);
  }
}

double Extent::largest() const { return empty() ? 0 : std::max(std::abs(low), std::abs(high)); }

int common_exponent(double largest) {
  if (!(largest > 0) || (largest >= 0.99e-2 && largest < 1e4)) return 0;
  return static_cast<int>(std::floor(std::log10(largest) + 0.02));  // 9.99e5 belongs to 1e6
}

double scaled(double x, int exponent) {
  const int half = exponent / 2;  // dividing twice avoids overflow for 10^308 and 10^-308
  return x / std::pow(10.0, half) / std::pow(10.0, exponent - half);
}

double Axis::place(double x) const {
  if (!logarithmic) return scaled(x, exponent);
  return x > 0 ? std::log10(x) : std::numeric_limits<double>::quiet_NaN();
}

std::vector<Tick> Axis::ticks() const {
  if (!words.empty()) return word_ticks(*this);
  return logarithmic ? logarithmic_ticks(*this) : linear_ticks(*this);
}

std::size_t Axis::widest_label() const {
  std::size_t widest = 1;
  for (const Tick& tick : ticks()) widest = std::max(widest, printed_length(tick.label));
  return widest;
}

Axis fit_axis(const Extent& extent, double edge, TickRoom room) {
  if (extent.empty()) return plain_axis(-1, 1, room);
  const int exponent = common_exponent(extent.largest());
  const double low = scaled(extent.low, exponent);
  const double high = scaled(extent.high, exponent);
  const double size = std::max(std::abs(low), std::abs(high));
  double margin = edge * (high - low);
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
      finer.step *= 0.8;  // a step of 4 in place of 5, if 5 leaves only one or two ticks
      return digit == 5 && axis.ticks().size() < 3 && fits(finer, room) ? finer : axis;
    }
  }
}

Axis word_axis(std::vector<std::string> words) {
  Axis axis{-0.5, static_cast<double>(words.size()) - 0.5};
  axis.words = std::move(words);
  return axis;
}

Axis log_axis(const Extent& extent) {
  Axis axis{-1, 1};
  axis.logarithmic = true;
  if (extent.empty()) return axis;
  const double low = std::log10(extent.low);
  const double high = std::log10(extent.high);
  const double room = std::max(0.04 * (high - low), 0.1);
  axis.low = low - room;
  axis.high = high + room;
  return axis;
}

}  // namespace hamflow::figures
