// Files of scenarios/ and page/, which the build embeds into the program.
#pragma once

#include <string>

namespace hamflow::reproduction {

/// Returns the text of a file, e.g. "scenarios/gas.toml".   @throws Error if there is no such file
const std::string& embedded_text(const std::string& file);

}  // namespace hamflow::reproduction
