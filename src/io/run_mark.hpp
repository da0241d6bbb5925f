// Which run wrote a run.h5. Each run draws a number when it begins, which stands in its checkpoint and in the attribute
// `run` of its run.h5: two runs of one scenario in the same second have different ones.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace hamflow {

/// 128 random bits as 32 hexadecimal digits.
std::string new_identity();

/// Nothing, if the file is of that run and has at least so many samples; else what is wrong with it, a phrase.
std::string refused_run_file(const std::filesystem::path& file, const std::string& identity, std::uint64_t rows);

}  // namespace hamflow
