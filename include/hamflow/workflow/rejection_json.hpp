// What `--json` prints in place of a summary.
#pragma once

#include <string>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// {"status": "rejected", "errors": [{file, line, column, key, message}, ...]}; key: a path, or an option; message:
/// what stands on stderr behind place and key.
std::string rejection_json(const std::vector<Complaint>& complaints);
/// The same of lines, whose parts are read from them.
std::string rejection_json(const std::vector<std::string>& lines);
/// {"status": "failed", "error": {kind, message}}
std::string failure_json(const std::string& kind, const std::string& message);

}  // namespace hamflow
