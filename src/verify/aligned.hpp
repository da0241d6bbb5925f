// Private to hamflow_verify: tables of plain text.
#pragma once

#include <string>
#include <vector>

namespace hamflow {

using Lines = std::vector<std::vector<std::string>>;

/// Columns as wide as their widest entry, two blanks between them. The last entry of a line that is shorter than the
/// first one is a remark, and widens nothing.
std::string aligned(const Lines& lines);

}  // namespace hamflow
