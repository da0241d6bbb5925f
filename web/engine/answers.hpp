// Answers of the engine to the page: texts of JSON that stay until the next answer.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hamflow/core/complaint.hpp"

namespace hamflow {

using Json = nlohmann::ordered_json;

const char* answered(const Json& json);
/// {"errors": [...]}
Json errors_of(const std::vector<Complaint>& complaints);
/// The exception that is being handled, as errors.
Json errors_of_exception();

/// The answer of a function, or its error.
template <class Function>
const char* guarded(Function&& function) {
  try {
    return answered(function());
  } catch (...) {
    return answered(errors_of_exception());
  }
}

}  // namespace hamflow
