// Writes the measured ratios as a table or as JSON.
#pragma once

#include <string>

#include "equal_error.hpp"
#include "timing.hpp"

namespace bench {

std::string as_text(const Measured& measured, const std::vector<EqualErrorComparison>& races, const Plan& plan);
std::string as_json(const Measured& measured, const std::vector<EqualErrorComparison>& races, const Plan& plan);

}  // namespace bench
