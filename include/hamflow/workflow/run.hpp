// A scenario becomes a run: its samples, checkpoints, summary and figures in a folder; or, without a folder, its tables
// in memory. This is what `hamflow run` calls; nothing here prints, reads the environment or catches signals.
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

/// How a scenario is carried out. None of it changes a bit of the trajectory.
struct RunSettings {
  std::filesystem::path folder{};  // empty: nothing is written
  Existing existing = Existing::refuse;
  bool samples = true;  // without a folder: whether samples, sections, events and bounces are kept in memory
  /// Called several times a second with the steps taken; returns false to stop at the step boundary reached. What it
  /// throws, and what an observer throws, ends the run and reaches the caller; files then are as a kill leaves them.
  std::function<bool(std::int64_t step)> pulse{};
  /// Called with what is worth a note, a sentence each.
  std::function<void(const std::string& note)> note{};
  /// Woken with the others. In a run with a folder their archive() is part of the checkpoints.
  std::vector<Observer*> observers{};
};

/// The result of a run. The summary has its numbers; some are repeated here, as the simulation returns them.
struct RunReport {
  Summary summary;
  std::string status;        // that of the summary: "done", "interrupted", "failed"
  std::string message;       // of a run that failed: what happened, a sentence
  std::string hint;          // and what can be done
  std::string details;       // the numbers of a step that found no solution
  std::string file_trouble;  // why not everything could be written; empty: it was. The numbers hold all the same
  std::vector<std::string> warnings{};  // what is plainly nonsense about it, "kind: message" each
  bool drawing_stopped = false;         // the run ended, its figures were not drawn because pulse() said to stop
  bool was_complete = false;            // resumed, and there was nothing to do
  Outcome outcome = Outcome::done;
  RunTables tables;  // of a run without a folder: what it recorded
  Frame final;
  Excursion energy;
  double energy_scale = 0;
  std::vector<InvariantExcursion> invariants;  // in the order of the problem
  std::optional<RunCertificate> certificate;
  double wall_seconds = 0;  // of all its parts
  std::string json;         // summary_json(summary), as in summary.json
  std::string text;         // summary_text(summary)
};

/// @throws Rejection when the scenario does not go on with the run in the folder   @throws Error when an observer has
/// no archive()   @throws FileError when the folder cannot be used
RunReport run(const Scenario& scenario, const RunSettings& settings = {});

/// Where `hamflow run` puts a run: `out` if given, else the scenario's folder, else <stem of its file>.run in the
/// working directory.
std::filesystem::path folder_of(const Scenario& scenario, const std::string& out = {});

}  // namespace hamflow
