// A number of a summary for people; null, as JSON writes what is not finite, is "nan".
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hamflow {

/// @param form of fmt, e.g. "{:.6g}"
std::string number_text(const nlohmann::ordered_json& x, const char* form);

}  // namespace hamflow
