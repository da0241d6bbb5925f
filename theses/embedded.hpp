// Files of scenarios/ and page/, which the build puts into the program.
#pragma once

#include <string>

namespace hamflow::reproduction {

/// The text of a file, e.g. "scenarios/gas.toml".   @throws Error where there is no such file
const std::string& embedded_text(const std::string& file);

}  // namespace hamflow::reproduction
