// What a sweep came to, as JSON and for people.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "sweep.hpp"

namespace hamflow {

/// One member: {"problem.mass": 1.0, ..., "status": ..., "final": {...}, "energy": {...}, ...}
nlohmann::ordered_json sweep_row(const Sweep& sweep, std::size_t member);
/// All of them together, with the first failures.
nlohmann::ordered_json sweep_summary(const Sweep& sweep, double seconds, bool interrupted);
std::string readable_sweep(const nlohmann::ordered_json& summary);

}  // namespace hamflow
