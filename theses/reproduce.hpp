// Repeats the figures, tables and statements of the two theses as experiments, and judges each by a rule. `hamflow
// reproduce` calls these functions.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "claim.hpp"
#include "hamflow/workflow/run.hpp"

namespace hamflow {

/// The length of the runs. All experiments together take about a minute, 20 minutes or 10 hours on two processors.
enum class WorkExtent { quick, usual, full };

struct ExperimentInfo {
  std::string id;      // "G2.8"
  std::string thesis;  // "Gross", "Sonnleitner"
  std::string page;
  std::string title;
};

/// All experiments, in the order of the theses.
std::vector<ExperimentInfo> experiment_infos();
/// Returns the IDs that the words name, each once. A word is an ID, "gross", "sonnleitner" or "all".
/// @throws Error for an unknown word, with the allowed words and the nearest ID
std::vector<std::string> named_experiments(const std::vector<std::string>& words);

struct ReproduceRequest {
  std::vector<std::string> ids;  // from named_experiments()
  WorkExtent extent = WorkExtent::usual;
  std::filesystem::path folder;
  Existing existing = Existing::refuse;
  int threads = 1;  // does not change verdicts
};

struct ExperimentReport {
  ExperimentInfo info;
  std::string status;   // "done", "failed", "interrupted"
  std::string message;  // why it failed
  std::vector<Claim> claims;
  WorkExtent extent = WorkExtent::usual;
  double seconds = 0;
  bool was_done = false;  // whether the result of an earlier reproduction was kept
};

struct ReproduceReport {
  std::string status;                         // "done"; "failed": an experiment failed; "interrupted"
  std::vector<ExperimentReport> experiments;  // the requested ones
  std::string json;  // the requested experiments; verdicts.json and the page contain all finished ones of the folder
  std::string text;  // for the terminal
};

/// Runs the experiments and writes the output directory: index.html, verdicts.json, and a folder for each experiment
/// with scenarios, curves and figures.
/// @param pulse called several times a second with the number of finished experiments; it returns false to stop.
/// Finished experiments are kept.
/// @throws FileError if the output directory cannot be used
ReproduceReport reproduce(const ReproduceRequest& request,
                          const std::function<bool(std::size_t done, std::size_t all)>& pulse = {});

/// Reads an experiment from the folder of a reproduction, in the largest size that is complete there. Returns nullopt
/// if the experiment was not run, or was run by another version.   @throws Error for an unknown ID
/// @throws FileError if the folder is not a reproduction
std::optional<ExperimentReport> stored_experiment(const std::filesystem::path& folder, const std::string& id);

}  // namespace hamflow
