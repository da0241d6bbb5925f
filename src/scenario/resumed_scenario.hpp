// The scenario of a run that goes on.
#pragma once

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// As read_scenario(), but a start that stands in a file is not missed where that file is gone: the run's own file
/// keeps it, which is noted.
/// @param folder where the run is; empty: where the scenario says
Reading read_resumed_scenario(const std::filesystem::path& file, const std::vector<std::string>& sets,
                              const std::string& folder);

}  // namespace hamflow
