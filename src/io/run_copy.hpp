// A run.h5 with other coordinates: everything is copied but the scenario, /q and /p.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hamflow {

/// @param source may also be a run that goes on or was cut short   @param target is replaced when it exists
/// @param q, p q[i][k]: coordinate i at sample k, as in RunSamples   @throws FileError
void copy_run_file(const std::filesystem::path& source, const std::filesystem::path& target,
                   const std::string& scenario, const std::vector<std::vector<double>>& q,
                   const std::vector<std::vector<double>>& p);

}  // namespace hamflow
