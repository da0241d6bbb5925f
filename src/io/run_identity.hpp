// Identifies the run that wrote a run.h5. Each run draws a random number when it begins, and stores it in its
// checkpoint and in the attribute `run` of its run.h5. So two runs of one scenario in the same second are different.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace hamflow {

/// Returns 128 random bits as 32 hexadecimal digits.
std::string new_identity();

/// Returns an empty text if the file belongs to that run and has at least `rows` samples; otherwise a phrase that says
/// what is wrong.
std::string refused_run_file(const std::filesystem::path& file, const std::string& identity, std::uint64_t rows);

}  // namespace hamflow
