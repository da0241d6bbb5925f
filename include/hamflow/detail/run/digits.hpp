// The numbers of a run beyond double as decimal texts, from which they read back to the last bit.
#pragma once

#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// The most characters, with sign and exponent, that a number with all its digits has in an arithmetic beyond double;
/// 0: its numbers are doubles.   @throws Error when there is no such arithmetic
std::size_t longest_digits(const std::string& arithmetic);

/// A state as decimal texts.
struct DigitState {
  std::vector<std::string> q;
  std::vector<std::string> p;
};

/// The state in the coordinates of another entry of the same problem, computed in the arithmetic; an angle lies within
/// half a turn of 0 where the coordinates before know no angles.   @throws Error where a chart does not reach
/// @param parameters complete
DigitState in_chart_of(const ProblemEntry& to, const ProblemEntry& from, const Texts& parameters,
                       const std::string& arithmetic, const DigitState& state);
/// An angle and some whole turns.
std::string turned(const std::string& angle, std::int64_t turns, const std::string& arithmetic);

/// Of two decimal texts, or number expressions.
std::string sum_of(const std::string& a, const std::string& b, const std::string& arithmetic);

/// x_k - x_0 of decimal texts. Subtracted with all their digits, and then rounded: what is left of two numbers that
/// agree in 40 digits is good to 18.
std::vector<long double> differences_from_first(const std::vector<std::string>& texts);

}  // namespace hamflow
