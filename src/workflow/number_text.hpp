// Formats the numbers of text summaries. A number that is not finite is written as "nan" or another word.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hamflow/workflow/summary.hpp"

namespace hamflow {

/// @param form format of fmt, for example "{:.6g}", for a number without a text of all its digits
/// @param none word for a number that is not finite
std::string number_text(const LongNumber& x, const char* form, const char* none = "nan");
/// Writes a quantity of the motion, which may be infinite.
inline std::string value_text(const LongNumber& x, const char* form) { return number_text(x, form, "not finite"); }
/// Writes numbers with all digits, separated by commas.
/// @param digits texts to print in place of the numbers, if not empty   @param none see number_text
std::string list_text(const std::vector<double>& numbers, const std::vector<std::string>& digits = {},
                      const char* none = "not finite");

/// Returns a number with the text of all its digits.
LongNumber with_digits(double x, const std::string& digits);
inline LongNumber time_of(const StateAtTime& state) { return with_digits(state.t, state.digits.time); }

/// Writes "1 point", "2 points".
std::string counted(std::size_t count, const std::string& what);

}  // namespace hamflow
