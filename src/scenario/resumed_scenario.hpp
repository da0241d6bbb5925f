// Reads the scenario of a run that is resumed.
#pragma once

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// Like read_scenario(). If the file with the initial particles no longer exists, the start is read from the file of
/// the run, with a note.
/// @param folder folder of the run; empty: the folder that the scenario gives
Reading read_resumed_scenario(const std::filesystem::path& file, const std::vector<std::string>& sets,
                              const std::string& folder);

}  // namespace hamflow
