// reverse.h5: the states of a reversal.
#pragma once

#include <filesystem>
#include <string>

#include "hamflow/run/simulation.hpp"

namespace hamflow {

/// Groups /start, /turn, /end, each with the datasets `q`, `p` and the attributes `t`, `step`, beyond double with
/// `digits/q` and `digits/p` too; and /scenario, the effective one. The file is whole or not there.
/// @param end null where the way back was not gone to its end   @throws FileError
void write_reverse_file(const std::filesystem::path& file, const std::string& scenario, const Frame& start,
                        const Frame& turn, const Frame* end);

}  // namespace hamflow
