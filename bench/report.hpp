// The measured ratios as a table to read or as JSON.
#pragma once

#include <string>

#include "timing.hpp"

namespace bench {

std::string as_text(const std::vector<Table>& tables, const Plan& plan);
std::string as_json(const std::vector<Table>& tables, const Plan& plan);

}  // namespace bench
