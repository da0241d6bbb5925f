// A number of a summary, as JSON and for people; null, as JSON writes what is not finite, is "nan".
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hamflow/verify/long_number.hpp"

namespace hamflow {

/// A number too small or too large for a double is a text.
nlohmann::ordered_json json_of(const LongNumber& x);
/// A text stays as it is.
/// @param form of fmt, e.g. "{:.6g}"
std::string number_text(const nlohmann::ordered_json& x, const char* form);

/// "1 point", "2 points".
std::string counted(std::size_t count, const std::string& what);

}  // namespace hamflow
