// Runs a scenario. Samples, checkpoints, summary and figures are written to a folder; without a folder the tables are
// kept in memory. `hamflow run` calls this; nothing here prints, reads the environment or catches signals.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/detail/run/run_tables.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "hamflow/verify/certificate.hpp"
#include "hamflow/workflow/summary.hpp"
#include "hamflow/workflow/work_folder.hpp"

namespace hamflow {

/// Settings that do not change the trajectory.
struct RunSettings {
  std::filesystem::path folder{};  // empty: nothing is written
  Existing existing = Existing::refuse;
  bool samples = true;  // without a folder: keep samples, sections, events and bounces in memory
  /// Called several times a second with the number of steps taken; returns false to stop after the current step.
  /// Exceptions of pulse and of observers end the run and reach the caller; the files are then left as after a kill.
  std::function<bool(std::int64_t step)> pulse{};
  /// Called with each note, a sentence.
  std::function<void(const std::string& note)> note{};
  /// Additional observers. In a run with a folder their archive() is part of the checkpoints.
  std::vector<Observer*> observers{};
};

/// Result of a run. Some numbers of the summary are repeated here as the simulation returns them.
struct RunReport {
  Summary summary;
  std::string status;   // status of the summary: "done", "interrupted", "failed"
  std::string message;  // after a failure: says what failed
  std::string hint;     // after a failure: what can be tried
  std::string details;  // iteration history of an implicit step without a solution
  // explains why a file could not be written; empty: all files were written. The results here are valid in any case
  std::string file_error;
  std::vector<std::string> warnings{};  // each is "kind: message"
  bool drawing_stopped = false;         // the run ended, but pulse() stopped the drawing of its figures
  bool was_complete = false;            // the run to be resumed was already complete
  Outcome outcome = Outcome::done;
  RunTables tables;  // tables of a run without a folder
  Frame final;
  Excursion energy;
  double energy_scale = 0;
  std::vector<InvariantExcursion> invariants;  // in the order in which the problem declares them
  std::optional<RunCertificate> certificate;
  double wall_seconds = 0;  // over all parts of a resumed run
  std::string json;         // summary_json(summary), the content of summary.json
  std::string text;         // summary_text(summary)
};

/// @throws Rejection if the run in the folder cannot be continued with this scenario
/// @throws Error if an observer has no archive()   @throws FileError if the folder cannot be used
RunReport run(const Scenario& scenario, const RunSettings& settings = {});

/// Returns the folder into which `hamflow run` writes: `out` if given, else the scenario's folder, else <stem of its
/// file>.run in the working directory.
std::filesystem::path folder_of(const Scenario& scenario, const std::string& out = {});

}  // namespace hamflow
