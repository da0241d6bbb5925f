// Double-double: the unevaluated sum of two doubles, about 32 digits, by the QD library.   [HidaLiBailey2001] Sums and
// quotients are QD's accurate versions: its defaults lose digits if terms cancel, as in differences of energies and
// invariants.
#pragma once

#include <algorithm>
#include <cmath>

#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/detail/arithmetic/extended.hpp"
#include "hamflow/detail/arithmetic/number_types.hpp"
#include "hamflow/detail/arithmetic/two_doubles.hpp"

namespace hamflow {

/// The two halves need not be adjacent: 1 + 1e-40 is a double-double. Numbers that span up to 320 bits read back from
/// this many decimal digits; numbers whose halves are more than 80 orders of magnitude apart do not.
inline constexpr int wide_digits = 98;
std::string written_wide(const dd_real& x);
/// The nearest double to a decimal, plus the nearest double to the rest.
dd_real read_wide(std::string_view text);
/// A decimal of any length, rounded to so many significant digits, without zeros at its end.
std::string rounded_decimal(const std::string& text, int digits);

template <>
struct ExtendedTraits<dd_real> {
  using T = dd_real;
  using Wider = ExtendedTraits<QuadNumber>;
  static constexpr int digits = 106;
  template <class U>
  static T made(U x) {
    const double high = static_cast<double>(x);
    if constexpr (std::is_same_v<U, double> || std::is_same_v<U, float> || sizeof(U) < sizeof(double)) {
      return T(high);
    } else {  // long double and 64-bit integers have more digits than one double
      return T(high, static_cast<double>(static_cast<long double>(x) - static_cast<long double>(high)));
    }
  }
  template <class U>
  static U as(const T& x) {
    using Sum = std::conditional_t<std::is_same_v<U, long double>, long double, Wide>;
    return static_cast<U>(static_cast<Sum>(x.x[0]) + static_cast<Sum>(x.x[1]));
  }
  static T add(const T& a, const T& b) { return T::ieee_add(a, b); }
  static T subtract(const T& a, const T& b) { return T::ieee_add(a, -b); }
  static T multiply(const T& a, const T& b) { return a * b; }
  static T divide(const T& a, const T& b) { return T::accurate_div(a, b); }
  static T abs(const T& x) { return ::abs(x); }
  // quad computes the value in cases in which QD reads beyond a table (angles that are NaN or too large for its
  // reduction), prints a message, divides infinity by infinity, or overflows in a square.
  static constexpr double largest_angle = 1e20;
  static constexpr double largest_exponent = 700;
  static constexpr double largest_side = 1e150;
  static T sqrt(const T& x) { return x.x[0] >= 0 && std::isfinite(x.x[0]) ? ::sqrt(x) : T(std::sqrt(x.x[0])); }
  static T exp(const T& x) { return ::exp(x); }
  static T log(const T& x) { return x.x[0] > 0 && std::isfinite(x.x[0]) ? ::log(x) : rounded(Wider::log(widened(x))); }
  static T sin(const T& x) { return is_below(x, largest_angle) ? ::sin(x) : rounded(Wider::sin(widened(x))); }
  static T cos(const T& x) { return is_below(x, largest_angle) ? ::cos(x) : rounded(Wider::cos(widened(x))); }
  static T tan(const T& x) { return is_below(x, largest_angle) ? ::tan(x) : rounded(Wider::tan(widened(x))); }
  static T asin(const T& x) { return ::abs(x) <= T(1.0) ? ::asin(x) : nan(); }
  static T acos(const T& x) { return ::abs(x) <= T(1.0) ? ::acos(x) : nan(); }
  static T atan(const T& x) { return is_below(x, largest_side) ? ::atan(x) : rounded(Wider::atan(widened(x))); }
  static T sinh(const T& x) { return is_below(x, largest_exponent) ? ::sinh(x) : rounded(Wider::sinh(widened(x))); }
  static T cosh(const T& x) { return is_below(x, largest_exponent) ? ::cosh(x) : rounded(Wider::cosh(widened(x))); }
  static T tanh(const T& x) { return is_below(x, largest_exponent) ? ::tanh(x) : rounded(Wider::tanh(widened(x))); }
  static T atan2(const T& y, const T& x) {
    const double side = std::max(std::abs(y.x[0]), std::abs(x.x[0]));
    const bool has_square = is_below(x, largest_side) && is_below(y, largest_side) && side > 1 / largest_side;
    return has_square ? ::atan2(y, x) : rounded(Wider::atan2(widened(y), widened(x)));
  }
  /// Computed with the logarithm; only whole powers for a number below 0.
  static T pow(const T& x, const T& y) {
    if (x.x[0] > 0 && std::isfinite(x.x[0])) return ::pow(x, y);
    const bool is_whole = ::floor(y) == y;
    if (!(x.x[0] < 0) || !is_whole || !std::isfinite(x.x[0])) return T(std::pow(x.x[0], y.x[0]));
    const bool is_odd = std::fmod(y.x[0], 2) + std::fmod(y.x[1], 2) != 0;
    const T size = ::pow(-x, y);
    return is_odd ? -size : size;
  }
  static bool is_below(const T& x, double limit) { return std::abs(x.x[0]) < limit; }
  static QuadNumber widened(const T& x) { return static_cast<QuadNumber>(x.x[0]) + static_cast<QuadNumber>(x.x[1]); }
  static T rounded(const QuadNumber& x) {
    const auto high = static_cast<double>(x);
    return std::isfinite(high) ? T(high, static_cast<double>(x - static_cast<QuadNumber>(high))) : T(high);
  }
  /// Reads a text in quad, whose reader rounds correctly; that of QD loses some digits. A text with more than 64 digits
  /// is read by read_wide(): written() makes such texts if quad cannot represent both halves.
  static T read(std::string_view text) {
    const std::string_view mantissa = text.substr(0, text.find_first_of("eE"));
    if (std::count_if(mantissa.begin(), mantissa.end(), [](char c) { return c >= '0' && c <= '9'; }) > 64) {
      return read_wide(text);
    }
    return rounded(Wider::read(text));
  }
  static std::string written(const T& x) {
    const QuadNumber sum = widened(x);
    const bool holds_both = sum - static_cast<QuadNumber>(x.x[0]) == static_cast<QuadNumber>(x.x[1]);
    return holds_both || !std::isfinite(x.x[0]) ? Wider::written(sum) : written_wide(x);
  }
  static T epsilon() { return T(0x1p-104); }
  static T max() { return T(std::numeric_limits<double>::max(), std::numeric_limits<double>::max() * 0x1p-54); }
  static T min() { return T(0x1p-969); }  // 2^-1022 2^53: below it the low part is subnormal
  static T infinity() { return T(std::numeric_limits<double>::infinity()); }
  static T nan() { return T(std::numeric_limits<double>::quiet_NaN()); }
};

using DoubleDouble = Extended<dd_real>;

template <>
inline DoubleDouble parse_decimal<DoubleDouble>(std::string_view text) {
  return DoubleDouble(ExtendedTraits<dd_real>::read(text));
}
extern template DoubleDouble evaluate_number<DoubleDouble>(std::string_view);  // in src/arithmetic/numbers.cpp

}  // namespace hamflow
