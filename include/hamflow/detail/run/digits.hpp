// Numbers of a run in arithmetic with more digits than double, as decimal texts that read back to the same bits.
#pragma once

#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// The largest number of characters of a number with all digits, sign and exponent in an arithmetic beyond double; 0 if
/// its numbers are doubles. @throws Error if there is no such arithmetic
std::size_t longest_digits(const std::string& arithmetic);

/// A state as decimal texts.
struct DigitState {
  std::vector<std::string> q;
  std::vector<std::string> p;
};

/// Converts a state to the coordinates of another entry of the same problem, in the given arithmetic. If the first
/// coordinates have no angles, angles are within half a revolution of 0. @throws Error outside the range of a chart
/// @param parameters complete
DigitState in_chart_of(const ProblemEntry& to, const ProblemEntry& from, const Texts& parameters,
                       const std::string& arithmetic, const DigitState& state);
/// An angle plus some whole turns.
std::string turned(const std::string& angle, std::int64_t turns, const std::string& arithmetic);

/// The sum of two decimal texts or number expressions.
std::string sum_of(const std::string& a, const std::string& b, const std::string& arithmetic);

/// x_k - x_0 of decimal texts, subtracted with all digits and then rounded: the difference of two numbers that agree in
/// 40 digits is accurate to 18.
std::vector<long double> differences_from_first(const std::vector<std::string>& texts);

}  // namespace hamflow
