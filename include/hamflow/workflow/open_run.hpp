// Reads a run from its folder into memory.
#pragma once

#include <filesystem>
#include <string>

#include "hamflow/detail/run/run_tables.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

struct OpenedRun {
  Scenario scenario;    // the scenario that was run
  RunTables tables;     // end with the last complete row
  std::string summary;  // summary.json; empty if the run has not ended or was killed
};

/// @param run folder of a run, or its run.h5; the run may still be running
/// @throws FileError if it cannot be read, or is not a run
OpenedRun open_run(const std::filesystem::path& run);

}  // namespace hamflow
