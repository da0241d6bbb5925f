// What `hamflow show ID` tells of an experiment: claims are made while it runs, so that only a folder has them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "reproduce.hpp"

namespace hamflow {

/// The experiment as it was carried out into the folder of a reproduction, in the largest size that is there whole.
/// Nothing where it was not, or by another version of it.   @throws Error for an unknown ID
/// @throws FileError where the folder is none of a reproduction
std::optional<ExperimentReport> kept_experiment(const std::filesystem::path& folder, const std::string& id);

}  // namespace hamflow
