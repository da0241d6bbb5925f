// JSON that `--json` prints in place of a summary.
#pragma once

#include <string>
#include <vector>

#include "hamflow/core/complaint.hpp"

namespace hamflow {

/// Returns {"status": "rejected", "errors": [{file, line, column, key, message}, ...]}. `key` is a path or an option;
/// `message` is what stderr shows after position and key.
std::string rejection_json(const std::vector<Complaint>& complaints);
/// Returns {"status": "failed", "error": {kind, message}}.
std::string failure_json(const std::string& kind, const std::string& message);

}  // namespace hamflow
