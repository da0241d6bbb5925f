// Numbers that may be below the range of double, such as errors of runs in hundreds of digits.
#pragma once

#include <string>
#include <vector>

namespace hamflow {

/// A number as a double, and also as text if it is too small or too large for a double; otherwise the text is empty.
struct LongNumber {
  double value = 0;
  std::string text{};
  LongNumber(double x = 0) : value(x) {}     // NOLINT: implicit conversion is intended
  operator double() const { return value; }  // NOLINT: most code only needs the double
};

/// Returns x times a decimal number of any size.
LongNumber times(double x, const std::string& decimal);
/// Returns x 10^exponent.
LongNumber times_power_of_ten(double x, int exponent);
LongNumber quotient(const LongNumber& a, const LongNumber& b);
bool at_most(const LongNumber& a, const LongNumber& b);
/// Returns the largest |a_i - b_i| of two lists of decimal numbers, computed in all their digits.
LongNumber largest_difference(const std::vector<std::string>& a, const std::vector<std::string>& b);

/// Differences of decimal numbers from the first one, divided by the largest difference.
struct ScaledDifferences {
  std::vector<double> values;  // in [-1, 1]
  std::string unit = "0";      // largest difference
};
ScaledDifferences differences_to_first(const std::vector<std::string>& numbers);

}  // namespace hamflow
