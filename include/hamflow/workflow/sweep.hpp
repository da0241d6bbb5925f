// A scenario for many values of some of its keys: one table, a row for each member, on all cores.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace hamflow {

inline constexpr int most_sweep_threads = 1024;

struct SweepRequest {
  std::string text;                 // of the scenario
  std::string name;                 // stands in messages
  std::vector<std::string> sets{};  // PATH=VALUE, for all members
  // PATH=a:b:n, PATH=v1,v2,... or PATH=FORMULA of other varied keys; every combination, the last one changing fastest
  std::vector<std::string> varied;
  bool zip = false;            // in place of every combination: the n-th value of each key together
  int threads = 0;             // 0: all cores; results do not depend on it
  std::string lanes = "auto";  // auto, none, generic, avx2, avx512; nor on this
};

struct SweepReport {
  std::string status;                 // "done", "interrupted"; "failed": no member came to its end
  std::vector<std::string> failures;  // the first ten, a sentence each
  std::vector<std::string> warnings;  // what is plainly nonsense about members that are done, "kind: message" each
  std::string json;                   // the summary
  std::string text;                   // for people
};

class ScenarioSweep {
 public:
  /// Reads and checks every member. Where something is wrong, complaints() holds it and nothing can be run.
  /// @throws FileError
  explicit ScenarioSweep(const SweepRequest& request);
  ~ScenarioSweep();
  ScenarioSweep(const ScenarioSweep&) = delete;
  ScenarioSweep& operator=(const ScenarioSweep&) = delete;

  /// A line each.
  const std::vector<std::string>& complaints() const;
  const std::vector<std::string>& notes() const;
  /// What is wrong with a figure of this sweep: with the file's name, the keys varied or the column; empty if nothing
  /// is. Without a column: the section of all members, where one is asked for, else energy/max_error.
  std::string refused_figure(const std::filesystem::path& file, const std::string& column) const;
  /// Of all members together.
  std::int64_t total_steps() const;

  /// Runs all members.   @param pulse called several times a second with the steps taken by all; returns false to stop
  SweepReport run(const std::function<bool(std::int64_t steps)>& pulse = {});
  /// The summary with a row for each member; without them where there are more than 10^4.
  std::string json_with_rows(const SweepReport& report) const;
  /// Writes the table in the scenario's formats, and summary.json, into a folder made before.   @throws FileError
  void write(const SweepReport& report, const std::filesystem::path& folder) const;
  /// A column over the one or two keys varied, or the section of all members.   @throws Error, FileError
  void draw(const std::filesystem::path& file, const std::string& column) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Makes the folder for a sweep. With `replace` what an earlier one left in it is removed, nothing else. Nobody else
/// writes into it while what is returned lives.
/// @throws FileError when it exists and `replace` is false, is that of a run or a comparison, or cannot be made
[[nodiscard]] std::shared_ptr<const void> make_sweep_folder(const std::filesystem::path& folder, bool replace);

}  // namespace hamflow
