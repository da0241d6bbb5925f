// Private to hamflow_verify: writes tables as plain text.
#pragma once

#include <string>
#include <vector>

namespace hamflow {

using Lines = std::vector<std::vector<std::string>>;

/// Makes each column as wide as its widest entry, with two blanks between columns. The last entry of a line that is
/// shorter than the first line is a remark, and does not widen its column.
std::string aligned(const Lines& lines);

}  // namespace hamflow
