// The experiments of the two theses, carried out again: figures, tables and statements, each judged by a rule. This is
// what `hamflow reproduce` calls.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "claim.hpp"
#include "hamflow/workflow/run.hpp"

namespace hamflow {

/// How much work an experiment may take: all of them together about a minute, 20 minutes, 10 hours on two processors.
enum class WorkExtent { quick, usual, full };

struct ExperimentInfo {
  std::string id;      // "G2.8"
  std::string thesis;  // "Gross", "Sonnleitner"
  std::string page;
  std::string title;
};

/// In the order of the theses.
std::vector<ExperimentInfo> experiment_infos();
/// The experiments that these words name: an ID, gross, sonnleitner, all; each once.
/// @throws Error for an unknown word, with what is allowed and the nearest ID
std::vector<std::string> named_experiments(const std::vector<std::string>& words);

struct ReproduceRequest {
  std::vector<std::string> ids;  // from named_experiments()
  WorkExtent extent = WorkExtent::usual;
  std::filesystem::path folder;
  Existing existing = Existing::refuse;
  int threads = 1;  // verdicts do not depend on it
};

struct ExperimentReport {
  ExperimentInfo info;
  std::string status;   // "done", "failed", "interrupted"
  std::string message;  // of one that could not be computed
  std::vector<Claim> claims;
  WorkExtent extent = WorkExtent::usual;
  double seconds = 0;
  bool was_done = false;  // before, and not again
};

struct ReproduceReport {
  std::string status;                         // "done"; "failed": an experiment could not be computed; "interrupted"
  std::vector<ExperimentReport> experiments;  // those asked for
  std::string json;  // of them; verdicts.json and the page have all experiments that are done in the folder
  std::string text;  // for people
};

/// Carries the experiments out and writes the folder: index.html, verdicts.json, and a folder for each experiment with
/// scenarios, curves and figures.
/// @param pulse called several times a second with the experiments done; returns false to stop; what is done is kept
/// @throws FileError when the folder cannot be used
ReproduceReport reproduce(const ReproduceRequest& request,
                          const std::function<bool(std::size_t done, std::size_t all)>& pulse = {});

/// The experiment as it was carried out into the folder of a reproduction, in the largest size that is there whole;
/// nullopt if it was not run, or was run by another version of it.   @throws Error for an unknown ID
/// @throws FileError where the folder is not that of a reproduction
std::optional<ExperimentReport> kept_experiment(const std::filesystem::path& folder, const std::string& id);

}  // namespace hamflow
