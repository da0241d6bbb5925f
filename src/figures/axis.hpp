// An axis: its range, its ticks and the power of ten taken out of both. gnuplot never sees anything but numbers of
// ordinary size, so ranges of 1e-16 or 1e300 need no care further down.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace hamflow::figures {

/// The finite numbers seen so far.
struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double x);
  void include(std::span<const double> xs);
  bool empty() const { return low > high; }
  /// The largest absolute value.
  double largest() const;
};

/// The power of ten to take out of numbers up to `largest`: 0 where they read well as they are.
int common_exponent(double largest);
/// x / 10^exponent, without overflow on the way.
double scaled(double x, int exponent);

struct Axis {
  double low = 0;  // in units of 10^exponent
  double high = 1;
  int exponent = 0;
  double step = 1;  // between ticks

  /// Positions (in units of 10^exponent) and labels.
  std::vector<std::pair<double, std::string>> ticks() const;
  /// Characters of the longest label.
  std::size_t widest_label() const;
};

/// How many ticks an axis takes, and how many characters their labels have room for.
struct TickRoom {
  std::size_t ticks = 7;
  std::size_t characters = 1000;
};

/// An axis that shows `extent` with `padding` (a fraction of its length) at either end. Where the numbers are all but
/// equal there is nothing to resolve: the axis then shows the size of the number.
Axis fit_axis(const Extent& extent, double padding, TickRoom room);
/// The same with a range that is already chosen: the ticks are as close as the room allows.
Axis plain_axis(double low, double high, TickRoom room);

}  // namespace hamflow::figures
