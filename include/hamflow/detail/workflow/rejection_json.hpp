// What `--json` prints in place of a summary.
#pragma once

#include <string>
#include <vector>

#include "hamflow/core/complaint.hpp"

namespace hamflow {

/// {"status": "rejected", "errors": [{file, line, column, key, message}, ...]}; key: a path, or an option; message:
/// what stands on stderr behind place and key.
std::string rejection_json(const std::vector<Complaint>& complaints);
/// {"status": "failed", "error": {kind, message}}
std::string failure_json(const std::string& kind, const std::string& message);

}  // namespace hamflow
