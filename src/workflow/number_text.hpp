// Numbers of summaries for people. What is not finite is "nan" or another word.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hamflow/workflow/summary.hpp"

namespace hamflow {

/// @param form of fmt, e.g. "{:.6g}", for a number that has no text of its own
/// @param none in place of what is not finite
std::string number_text(const LongNumber& x, const char* form, const char* none = "nan");
/// Of a quantity of the motion, which may well be infinite.
inline std::string value_text(const LongNumber& x, const char* form) { return number_text(x, form, "not finite"); }
/// Numbers with commas between them, with all digits.
/// @param digits in place of the numbers, where there are any   @param none see number_text
std::string list_text(const std::vector<double>& numbers, const std::vector<std::string>& digits = {},
                      const char* none = "not finite");

/// A number with the digits that it has beyond double.
LongNumber with_digits(double x, const std::string& digits);
inline LongNumber time_of(const StateAtTime& state) { return with_digits(state.t, state.digits.time); }

/// "1 point", "2 points".
std::string counted(std::size_t count, const std::string& what);

}  // namespace hamflow
