// A number of a summary, as JSON and for people; null, as JSON writes inf and nan alike, is "nan" or another word.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hamflow/verify/long_number.hpp"

namespace hamflow {

struct MemberStop;

/// A number too small or too large for a double is a text.
nlohmann::ordered_json json_of(const LongNumber& x);
/// The event that ended a run, its state in all digits where there are more than those of a double.
nlohmann::ordered_json json_of(const std::string& event, const MemberStop& stop);
/// A text stays as it is.
/// @param form of fmt, e.g. "{:.6g}"   @param none in place of what is not finite
std::string number_text(const nlohmann::ordered_json& x, const char* form, const char* none = "nan");
/// Of a quantity of the motion, which may well be infinite.
inline std::string value_text(const nlohmann::ordered_json& x, const char* form) {
  return number_text(x, form, "not finite");
}

/// "1 point", "2 points".
std::string counted(std::size_t count, const std::string& what);

}  // namespace hamflow
