// Results that a double may be too small for: errors of runs in hundreds of digits.
#pragma once

#include <string>
#include <vector>

namespace hamflow {

/// A number as a double, and as a text where it is too small or too large to be one; else the text is empty.
struct LongNumber {
  double value = 0;
  std::string text{};
  LongNumber(double x = 0) : value(x) {}     // NOLINT: every double is one of these
  operator double() const { return value; }  // NOLINT: what most readers want
};

/// x times a decimal number of any size.
LongNumber times(double x, const std::string& decimal);
/// x 10^exponent.
LongNumber times_power_of_ten(double x, int exponent);
LongNumber quotient(const LongNumber& a, const LongNumber& b);
bool at_most(const LongNumber& a, const LongNumber& b);
/// The largest of |a_i - b_i| for lists of decimal numbers, computed in all their digits.
LongNumber largest_difference(const std::vector<std::string>& a, const std::vector<std::string>& b);

/// Decimal numbers less the first of them, over the largest of these differences.
struct ScaledDifferences {
  std::vector<double> values;  // at most 1 in size
  std::string unit = "0";      // the largest difference
};
ScaledDifferences differences_to_first(const std::vector<std::string>& numbers);

}  // namespace hamflow
