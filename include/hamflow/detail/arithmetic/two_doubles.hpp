// The numbers behind double-double: those of the QD library or, in a portable build, the same bits of sums, products,
// quotients and square roots without it. Elementary functions are then computed with 113 digits and rounded, and may
// differ from those of QD in the last digit.   [HidaLiBailey2001, Dekker1971]
#pragma once

#ifndef HAMFLOW_PORTABLE
#include <qd/dd_real.h>
#else
#include <cmath>

/// x[0] + x[1], where x[0] is the sum rounded to double.
struct dd_real {
  double x[2];

  dd_real() : x{0, 0} {}
  dd_real(double high, double low) : x{high, low} {}
  dd_real(double high) : x{high, 0} {}  // NOLINT: every double is one of these

  /// a + b without an error, for |a| >= |b|.
  static dd_real ordered_sum(double a, double b) {
    const double sum = a + b;
    return {sum, b - (sum - a)};
  }
  /// a + b without an error.
  static dd_real exact_sum(double a, double b) {
    const double sum = a + b;
    const double part = sum - a;
    return {sum, (a - (sum - part)) + (b - part)};
  }
  /// a b without an error, up to about 2^996.
  static dd_real exact_product(double a, double b) {
    const double product = a * b;
    const dd_real s = halves(a), t = halves(b);
    return {product, ((s.x[0] * t.x[0] - product) + s.x[0] * t.x[1] + s.x[1] * t.x[0]) + s.x[1] * t.x[1]};
  }
  /// a as two numbers of 26 binary digits, whose products are exact.
  static dd_real halves(double a) {
    const bool is_large = std::abs(a) > 0x1p996;
    const double scaled = is_large ? a * 0x1p-28 : a;
    const double moved = 134217729.0 * scaled;  // 2^27 + 1
    const double high = moved - (moved - scaled);
    const double low = scaled - high;
    return is_large ? dd_real{high * 0x1p28, low * 0x1p28} : dd_real{high, low};
  }

  /// To all digits of the sum, even where the summands cancel.
  static dd_real ieee_add(const dd_real& a, const dd_real& b) {
    const dd_real high = exact_sum(a.x[0], b.x[0]), low = exact_sum(a.x[1], b.x[1]);
    const dd_real sum = ordered_sum(high.x[0], high.x[1] + low.x[0]);
    return ordered_sum(sum.x[0], sum.x[1] + low.x[1]);
  }
  static dd_real accurate_div(const dd_real& a, const dd_real& b) {
    const double first = a.x[0] / b.x[0];
    dd_real rest = a - b.times(first);
    const double second = rest.x[0] / b.x[0];
    rest = rest - b.times(second);
    const double third = rest.x[0] / b.x[0];
    const dd_real quotient = ordered_sum(first, second);
    const dd_real sum = exact_sum(quotient.x[0], third);
    return ordered_sum(sum.x[0], sum.x[1] + quotient.x[1]);
  }

  dd_real times(double b) const {
    const dd_real product = exact_product(x[0], b);
    return ordered_sum(product.x[0], product.x[1] + x[1] * b);
  }
  friend dd_real operator*(const dd_real& a, const dd_real& b) {
    const dd_real product = exact_product(a.x[0], b.x[0]);
    return ordered_sum(product.x[0], product.x[1] + (a.x[0] * b.x[1] + a.x[1] * b.x[0]));
  }
  /// Loses digits where a and b cancel.
  friend dd_real operator-(const dd_real& a, const dd_real& b) {
    const dd_real difference = exact_sum(a.x[0], -b.x[0]);
    return ordered_sum(difference.x[0], difference.x[1] + a.x[1] - b.x[1]);
  }
  dd_real operator-() const { return {-x[0], -x[1]}; }

  friend bool operator==(const dd_real& a, const dd_real& b) { return a.x[0] == b.x[0] && a.x[1] == b.x[1]; }
  friend bool operator<(const dd_real& a, const dd_real& b) {
    return a.x[0] < b.x[0] || (a.x[0] == b.x[0] && a.x[1] < b.x[1]);
  }
  friend bool operator>(const dd_real& a, const dd_real& b) { return b < a; }
  friend bool operator<=(const dd_real& a, const dd_real& b) {
    return a.x[0] < b.x[0] || (a.x[0] == b.x[0] && a.x[1] <= b.x[1]);
  }
  friend bool operator>=(const dd_real& a, const dd_real& b) { return b <= a; }
};

inline dd_real abs(const dd_real& a) { return a.x[0] < 0 ? -a : a; }
inline dd_real floor(const dd_real& a) {
  const double high = std::floor(a.x[0]);
  return high == a.x[0] ? dd_real::ordered_sum(high, std::floor(a.x[1])) : dd_real(high);
}
/// One step of Newton from the root of a double; a >= 0.
inline dd_real sqrt(const dd_real& a) {
  if (a.x[0] == 0) return 0.0;
  const double inverse = 1 / std::sqrt(a.x[0]);
  const double root = a.x[0] * inverse;
  // The square in the order in which QD adds its parts.
  const dd_real s = dd_real::halves(root);
  const double square = root * root;
  const dd_real whole(square, ((s.x[0] * s.x[0] - square) + 2 * s.x[0] * s.x[1]) + s.x[1] * s.x[1]);
  return dd_real::exact_sum(root, (a - whole).x[0] * (inverse * 0.5));
}

// In src/portable/two_doubles.cpp.
dd_real exp(const dd_real& x);
dd_real log(const dd_real& x);
dd_real sin(const dd_real& x);
dd_real cos(const dd_real& x);
dd_real tan(const dd_real& x);
dd_real asin(const dd_real& x);
dd_real acos(const dd_real& x);
dd_real atan(const dd_real& x);
dd_real sinh(const dd_real& x);
dd_real cosh(const dd_real& x);
dd_real tanh(const dd_real& x);
dd_real atan2(const dd_real& y, const dd_real& x);
dd_real pow(const dd_real& x, const dd_real& y);
#endif
