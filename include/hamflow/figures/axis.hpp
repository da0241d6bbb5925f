// Axis: its range, its ticks, and a power of ten that is taken out of both. gnuplot only gets numbers of ordinary size,
// and logarithms for a logarithmic axis, so ranges of 1e-16 or 1e300 need no special treatment elsewhere.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace hamflow::figures {

/// Range of the finite numbers seen so far.
struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double x);
  void include(std::span<const double> xs);
  /// Includes only numbers above 0, which a logarithmic axis can show.
  void include_positive(std::span<const double> xs);
  bool empty() const { return low > high; }
  /// Largest absolute value.
  double largest() const;
};

constexpr double resolvable = 1e-5;  // a shorter range, relative to the numbers, has unreadable labels

/// Returns the power of ten to take out of numbers up to `largest`; 0 if they are readable as they are.
int common_exponent(double largest);
/// Returns x / 10^exponent, without overflow in between.
double scaled(double x, int exponent);

struct Tick {
  double at = 0;      // position as given by `Axis::place`
  std::string label;  // enhanced text; empty: a tick without label
  bool minor = false;
};

struct Axis {
  double low = 0;  // as given by `place`: in units of 10^exponent, or log10
  double high = 1;
  int exponent = 0;  // only for a linear axis
  double step = 1;   // distance of the ticks of a linear axis
  bool logarithmic = false;
  std::vector<std::string> words{};  // labels at 0, 1, 2, ... in place of numbers, enhanced text

  /// Returns the position of x on the axis; not finite if x has none.
  double place(double x) const;
  std::vector<Tick> ticks() const;
  /// Returns the number of printed characters of the longest label.
  std::size_t widest_label() const;
};

/// Number of ticks on an axis, and of characters in all their labels, that fit.
struct TickRoom {
  std::size_t ticks = 7;
  std::size_t characters = 1000;
};

/// Makes an axis that shows `extent` with a margin of `edge` at both ends, as a fraction of its length. If the numbers
/// are almost equal, there is nothing to resolve, and the axis shows the size of the number.
Axis fit_axis(const Extent& extent, double edge, TickRoom room);
/// The same for a given range, with ticks as close as `room` allows.
Axis plain_axis(double low, double high, TickRoom room);
/// Makes an axis with words at 0, 1, 2, ...
Axis word_axis(std::vector<std::string> words);
/// Makes a logarithmic axis for an extent of positive numbers, with a margin at both ends; 0.1 .. 10 if there are none.
Axis log_axis(const Extent& extent);

}  // namespace hamflow::figures
