// Size of an error in any arithmetic. In mp(400), for example, it can be smaller than any double.
#pragma once

#include <cmath>
#include <limits>
#include <string>

namespace hamflow {

struct Magnitude {
  double value = 0;                                         // 0 if below the range of double
  double log10 = -std::numeric_limits<double>::infinity();  // correct also below the range of double
  // for example "3.1416e-412", if below the range of double; else empty
  std::string text{};
  Magnitude(double x = 0) : value(x), log10(std::log10(x)) {}  // NOLINT: implicit conversion is intended
  explicit Magnitude(const std::string& decimal);              // reads a number with any exponent

  friend bool operator<(const Magnitude& a, const Magnitude& b) { return a.log10 < b.log10; }
};

/// Writes x with `digits` digits after the first one.
std::string readable(const Magnitude& x, int digits = 1);

}  // namespace hamflow
