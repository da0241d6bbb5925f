// The size of an error in any arithmetic: of mp(400) it can be smaller than any double.
#pragma once

#include <cmath>
#include <limits>
#include <string>

namespace hamflow {

struct Magnitude {
  double value = 0;                                         // 0 where the doubles end
  double log10 = -std::numeric_limits<double>::infinity();  // known there too
  std::string text{};                                       // "3.1416e-412" where the doubles end, else empty

  Magnitude(double x = 0) : value(x), log10(std::log10(x)) {}  // NOLINT: a double is one
  explicit Magnitude(const std::string& decimal);              // of a number with any exponent

  friend bool operator<(const Magnitude& a, const Magnitude& b) { return a.log10 < b.log10; }
};

/// For people, with so many digits behind the first.
std::string readable(const Magnitude& x, int digits = 1);

}  // namespace hamflow
