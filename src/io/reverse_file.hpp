// reverse.h5: the states of a reversal.
#pragma once

#include <filesystem>
#include <string>

#include "hamflow/run/simulation.hpp"

namespace hamflow {

/// Writes the groups /start, /turn, /end, each with the datasets `q` and `p` and the attributes `t` and `step`, beyond
/// double also with `digits/q` and `digits/p`; and /scenario, the effective scenario. The file is written as a whole or
/// not at all.
/// @param end null if the second half of the reversal was not finished   @throws FileError
void write_reverse_file(const std::filesystem::path& file, const std::string& scenario, const Frame& start,
                        const Frame& turn, const Frame* end);

}  // namespace hamflow
