// An axis: its range, its ticks and the power of ten taken out of both. gnuplot never sees anything but numbers of
// ordinary size, so ranges of 1e-16 or 1e300 need no care further down; of a logarithmic axis it sees logarithms.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace hamflow::figures {

/// The finite numbers seen so far.
struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double x);
  void include(std::span<const double> xs);
  /// Those above 0, which a logarithmic axis can show.
  void include_positive(std::span<const double> xs);
  bool empty() const { return low > high; }
  /// The largest absolute value.
  double largest() const;
};

constexpr double resolvable = 1e-5;  // a shorter range, relative to the numbers, has unreadable labels

/// The power of ten to take out of numbers up to `largest`: 0 where they read well as they are.
int common_exponent(double largest);
/// x / 10^exponent, without overflow on the way.
double scaled(double x, int exponent);

struct Tick {
  double at = 0;      // where `Axis::place` puts the number
  std::string label;  // enhanced text; empty: a mark without label
  bool minor = false;
};

struct Axis {
  double low = 0;  // as `place` puts it: in units of 10^exponent, or log10
  double high = 1;
  int exponent = 0;  // of a linear axis
  double step = 1;   // between the ticks of a linear axis
  bool logarithmic = false;
  std::vector<std::string> words{};  // enhanced text, instead of numbers, at 0, 1, 2, ...

  /// The position of x on the axis; not finite where it has none.
  double place(double x) const;
  std::vector<Tick> ticks() const;
  /// Characters of the longest label in print.
  std::size_t widest_label() const;
};

/// How many ticks an axis takes, and how many characters their labels have room for.
struct TickRoom {
  std::size_t ticks = 7;
  std::size_t characters = 1000;
};

/// An axis that shows `extent` with `edge` (a fraction of its length) at either end. Where the numbers are all but
/// equal there is nothing to resolve: the axis then shows the size of the number.
Axis fit_axis(const Extent& extent, double edge, TickRoom room);
/// The same with a range that is already chosen: the ticks are as close as the room allows.
Axis plain_axis(double low, double high, TickRoom room);
/// An axis of words, at 0, 1, 2, ...
Axis word_axis(std::vector<std::string> words);
/// A logarithmic axis over an extent of positive numbers, with some room at either end; 0.1 .. 10 where there are none.
Axis log_axis(const Extent& extent);

}  // namespace hamflow::figures
