// Writes and reads the folder of an experiment: result.json with claims, scenarios, curves as CSV and HDF5, figures.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiment.hpp"

namespace hamflow::reproduction {

/// The stored results of an experiment that the report needs.
struct StoredResults {
  std::vector<Claim> claims;
  std::vector<std::string> notes;
  std::vector<TextTable> tables;
  std::vector<StoredScenario> scenarios;  // without texts, which are separate files
  struct Drawing {
    std::string name, caption, in_words;
  };
  std::vector<Drawing> drawings;
  double seconds = 0;
};

nlohmann::ordered_json json_of(const Claim& claim);
/// Writes JSON as text. NaN and infinite numbers become null; invalid UTF-8 is replaced.
std::string text_of(const nlohmann::ordered_json& json);

/// Version, extent and source text of an experiment. If the fingerprint has changed, the experiment runs again.
std::string fingerprint(const Experiment& experiment, WorkExtent extent);
std::string fingerprint_of(const std::string& id, WorkExtent extent);
/// Returns "quick", "default" or "full".
std::string name_of(WorkExtent extent);
/// Stored results and their extent.
struct StoredExperiment {
  StoredResults kept;
  WorkExtent extent;
};
std::optional<StoredExperiment> read_stored_experiment(const Experiment& experiment,
                                                       const std::filesystem::path& folder);

/// Writes all files of an experiment, with figures as SVG, PDF and PNG. result.json is written last, so that the folder
/// of a killed program does not count as finished.   @throws FileError
void keep(const std::filesystem::path& folder, const Study& study, const std::string& fingerprint, double seconds);
/// Reads stored results. Returns nullopt if there are none, if the fingerprint differs, if a verdict does not follow
/// from its numbers, or if a file is missing or was changed.
std::optional<StoredResults> read_stored_results(const std::filesystem::path& folder, const std::string& fingerprint);

}  // namespace hamflow::reproduction
