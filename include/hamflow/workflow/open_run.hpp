// A run that is in a folder, as it was in memory.
#pragma once

#include <filesystem>
#include <string>

#include "hamflow/detail/run/run_tables.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

struct OpenedRun {
  Scenario scenario;    // that was carried out
  RunTables tables;     // up to the last complete row
  std::string summary;  // summary.json; empty where the run goes on or was cut short
};

/// @param run the folder of a run, or its run.h5, also while it grows
/// @throws FileError where it cannot be read, or is no run
OpenedRun open_run(const std::filesystem::path& run);

}  // namespace hamflow
