// What is kept of an experiment in its folder: result.json with its claims, scenarios, curves as CSV and HDF5, figures.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiment.hpp"

namespace hamflow::reproduction {

/// What the report needs of an experiment that is done.
struct Kept {
  std::vector<Claim> claims;
  std::vector<std::string> notes;
  std::vector<TextTable> tables;
  std::vector<KeptScenario> scenarios;  // without their texts, which are files of their own
  struct Drawing {
    std::string name, caption, in_words;
  };
  std::vector<Drawing> drawings;
  double seconds = 0;
};

nlohmann::ordered_json json_of(const Claim& claim);
/// Text of a document; numbers that are none become null, broken UTF-8 is replaced.
std::string text_of(const nlohmann::ordered_json& json);

/// What decides whether an experiment has to be carried out again: version, extent, and the text of its file.
std::string fingerprint(const Experiment& experiment, WorkExtent extent);
std::string fingerprint_of(const std::string& id, WorkExtent extent);
/// "quick", "default", "full".
std::string name_of(WorkExtent extent);
/// What is done of an experiment in its folder, of whichever extent.
struct KeptOf {
  Kept kept;
  WorkExtent extent;
};
std::optional<KeptOf> kept_of(const Experiment& experiment, const std::filesystem::path& folder);

/// Writes everything, figures as SVG, PDF and PNG; result.json is the last, so that what a kill interrupts is not taken
/// for done.   @throws FileError
void keep(const std::filesystem::path& folder, const Study& study, const std::string& fingerprint, double seconds);
/// Nothing where the folder holds no such result, one of another fingerprint, one whose verdicts do not follow from its
/// numbers, or one of whose files is missing or not as it was written.
std::optional<Kept> kept_in(const std::filesystem::path& folder, const std::string& fingerprint);

}  // namespace hamflow::reproduction
