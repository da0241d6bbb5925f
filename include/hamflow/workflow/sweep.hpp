// Runs a scenario for many values of some of its keys, on all cores. Each row of the table is a member.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hamflow/core/table.hpp"
#include "hamflow/detail/run/sweep_shard.hpp"
#include "hamflow/detail/workflow/sweep_summary.hpp"
#include "hamflow/workflow/run.hpp"

namespace hamflow {

inline constexpr int most_sweep_threads = 1024;

struct SweepRequest {
  std::string text;                 // text of the scenario
  std::string name;                 // name of the scenario in messages
  std::vector<std::string> sets{};  // PATH=VALUE, for all members
  // PATH=a:b:n, PATH=v1,v2,... or PATH=FORMULA of other varied keys. Every combination is run; the last key varies
  // fastest.
  std::vector<std::string> varied;
  bool zip = false;  // combine the n-th values of all keys, in place of every combination
  // Results do not depend on the number of threads, the lanes or the shard.
  int threads = 0;             // 0: all cores
  std::string lanes = "auto";  // auto, none, generic, avx2, avx512
  SweepShard shard{};          // only members of this shard are read and run
};

struct SweepReport {
  SweepSummary summary;
  std::string status;                 // status of the summary
  std::vector<std::string> failures;  // the first ten failures, a sentence each
  std::string hint;                   // what can be tried after the first failure; may be empty
  std::vector<std::string> warnings;  // about finished members, each "kind: message"
  std::string json;                   // sweep_json(summary, false), the content of summary.json
  std::string text;                   // sweep_text(summary)
};

/// "3/64" or "auto": the number of this process among all of a job, from the variables of Slurm, Open MPI or PMI.
/// @throws Rejection
SweepShard shard_named(const std::string& text);
/// The folder of a shard, FOLDER/shard-3-of-64; the folder itself for the whole.
std::filesystem::path shard_folder(const SweepShard& shard, const std::filesystem::path& folder);
/// The folders of shards in a folder, ordered by count and index.
std::vector<std::filesystem::path> shard_folders(const std::filesystem::path& folder);
/// The request of the sweep that is stored in a folder, by a process or by shards. With ScenarioSweep::keep_in and
/// Existing::resume it merges what all shards have finished.   @throws FileError
SweepRequest stored_sweep(const std::filesystem::path& folder);

class ScenarioSweep {
 public:
  /// Reads and checks every member. complaints() lists errors; if there are any, the sweep cannot run.
  /// @throws FileError   @throws ReadingStopped if a StopQuestion of the caller's thread asks to stop
  explicit ScenarioSweep(const SweepRequest& request);
  ~ScenarioSweep();
  ScenarioSweep(const ScenarioSweep&) = delete;
  ScenarioSweep& operator=(const ScenarioSweep&) = delete;

  const std::vector<Complaint>& complaints() const;
  const std::vector<std::string>& notes() const;
  /// Checks that a figure of this sweep can be drawn. An empty column means the Poincare section of all members if the
  /// scenario has one, otherwise energy/max_error.
  /// @param column with `mean` several columns are allowed, separated by commas; their means over all varied keys
  /// except the first are drawn
  /// @throws Rejection if the file's name, the varied keys or the column are wrong
  void check_figure(const std::filesystem::path& file, const std::string& column, bool mean = false) const;
  /// The shards that have members which are not finished, "3/64" each; empty if there are no shards in the folder.
  std::vector<std::string> missing_shards() const;
  /// Number of steps of all members together.
  std::int64_t total_steps() const;
  /// Number of steps of the members that an earlier part has finished.
  std::int64_t steps_before() const;

  /// Stores the sweep in a folder: its table in the formats of the scenario, rewritten regularly while the sweep runs,
  /// and the checkpoint members.bin. With Existing::resume, members that the checkpoint contains are not run again, and
  /// the table is bit for bit that of an uninterrupted sweep; the scenario may differ only in keys that may change when
  /// a run is resumed. Call it once, before run(). The folder stays locked while this object exists.
  /// A shard uses a folder of its own in it, without a table; with Existing::resume it does not run again what another
  /// shard has finished. The whole sweep then takes what all shards have finished.
  /// @return errors that forbid resuming; then no file was touched and the sweep cannot run
  /// @throws FileError if the folder exists and must not be used, belongs to a run or a comparison, or cannot be made
  [[nodiscard]] std::vector<Complaint> keep_in(const std::filesystem::path& folder, Existing existing);

  /// Runs all members that are not finished, and writes the folder, if there is one, also after an early stop.
  /// @param pulse called several times a second, on the caller's thread, with the number of steps taken by all members;
  /// returns false to stop. An exception of pulse stops the sweep and reaches the caller.   @throws FileError
  SweepReport run(const std::function<bool(std::int64_t steps)>& pulse = {});
  /// Returns the finished members of this shard, in the format of members.bin. Another process accepts them with
  /// take().
  std::vector<std::byte> finished_members() const;
  /// Accepts members that another process has finished. They are not run again, and are stored in the folder, if there
  /// is one. @throws Error if the bytes are damaged, or come from another sweep or another version of hamflow
  void take(std::span<const std::byte> finished_members);
  /// Returns a report of the members finished so far; writes the folder, if there is one. @throws FileError
  SweepReport report();
  /// Returns a table with a row for each member, finished or not: varied/KEY, member/status, member/steps, final/t,
  /// final/q, final/p, energy/..., invariants/..., events/..., observables/... (docs/reference/files.md, sweep.h5).
  Table members() const;
  /// Returns a table with a row for each point of the members' Poincare sections: section/member, section/t, section/q,
  /// section/p.
  Table sections() const;
  /// Returns the summary with its rows.
  std::string json_with_rows(const SweepReport& report) const { return sweep_json(report.summary, true); }
  /// Draws a column as a function of the one or two varied keys, or the Poincare section of all members. With `mean`,
  /// draws means of columns over all keys except the first, with standard errors, as functions of the first key.
  /// @throws Error, FileError
  void draw(const std::filesystem::path& file, const std::string& column, bool mean = false) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hamflow
