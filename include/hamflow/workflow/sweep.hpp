// A scenario for many values of some of its keys: one table, a row for each member, on all cores.
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
  std::string text;                 // of the scenario
  std::string name;                 // stands in messages
  std::vector<std::string> sets{};  // PATH=VALUE, for all members
  // PATH=a:b:n, PATH=v1,v2,... or PATH=FORMULA of other varied keys; every combination, the last one changing fastest
  std::vector<std::string> varied;
  bool zip = false;            // in place of every combination: the n-th value of each key together
  int threads = 0;             // 0: all cores; results do not depend on it
  std::string lanes = "auto";  // auto, none, generic, avx2, avx512; nor on this
  SweepShard shard{};          // its members alone are read and run; nor on this
};

struct SweepReport {
  SweepSummary summary;
  std::string status;                 // that of the summary
  std::vector<std::string> failures;  // the first ten, a sentence each
  std::string hint;                   // what helps against the first of them; often nothing
  std::vector<std::string> warnings;  // what is plainly nonsense about members that are done, "kind: message" each
  std::string json;                   // sweep_json(summary, false), as in summary.json
  std::string text;                   // sweep_text(summary)
};

class ScenarioSweep {
 public:
  /// Reads and checks every member. Where something is wrong, complaints() holds it and nothing can be run.
  /// @throws FileError   @throws ReadingStopped where a StopQuestion of the caller's thread is answered
  explicit ScenarioSweep(const SweepRequest& request);
  ~ScenarioSweep();
  ScenarioSweep(const ScenarioSweep&) = delete;
  ScenarioSweep& operator=(const ScenarioSweep&) = delete;

  const std::vector<Complaint>& complaints() const;
  const std::vector<std::string>& notes() const;
  /// Whether a figure of this sweep can be drawn. Without a column: the section of all members, where one is asked for,
  /// else energy/max_error.
  /// @param column also several, commas between, with `mean`: their means over all keys but the first one varied
  /// @throws Rejection for the file's name, the keys varied or the column
  void check_figure(const std::filesystem::path& file, const std::string& column, bool mean = false) const;
  /// Of all members together.
  std::int64_t total_steps() const;
  /// Of members that were finished before.
  std::int64_t steps_before() const;

  /// Keeps the sweep in a folder: its table in the scenario's formats, written again and again while it runs, and
  /// members.bin, from which it goes on. With Existing::resume members that are finished there are not run again, and
  /// the table becomes, bit for bit, that of a sweep that was never stopped; of the scenario only what may change when
  /// a run goes on may have changed. To be called once, before run(). Nobody else writes into the folder while this
  /// lives.
  /// @return what is wrong with going on: then nothing was touched, and nothing can be run
  /// @throws FileError when the folder exists and is not to be used, is that of a run or a comparison, or cannot be
  /// made
  [[nodiscard]] std::vector<Complaint> keep_in(const std::filesystem::path& folder, Existing existing);

  /// Runs all members that are not finished, and writes the folder, if there is one, also where it was stopped.
  /// @throws FileError   @param pulse called several times a second, on the thread of the caller, with the steps taken
  /// by all; returns false to stop. What it throws stops the sweep and reaches the caller.
  SweepReport run(const std::function<bool(std::int64_t steps)>& pulse = {});
  /// The members of this shard that are finished, as members.bin holds them: another process takes them with take().
  std::vector<std::byte> finished_members() const;
  /// Takes members that another process has finished: they are not run again, and are kept in the folder, if there is
  /// one. @throws Error when the bytes are damaged, or those of another sweep or another version of hamflow
  void take(std::span<const std::byte> finished_members);
  /// What there is so far, also where members are left; writes the folder, if there is one. @throws FileError
  SweepReport report();
  /// A row for each member, also while some are not finished: varied/KEY, member/status, member/steps, final/t,
  /// final/q, final/p, energy/..., invariants/..., events/..., observables/... (docs/reference/files.md, sweep.h5).
  Table members() const;
  /// A row for each point of the members' sections: section/member, section/t, section/q, section/p.
  Table sections() const;
  /// The summary with its rows.
  std::string json_with_rows(const SweepReport& report) const { return sweep_json(report.summary, true); }
  /// A column over the one or two keys varied, or the section of all members; or, over the first key, means of columns
  /// over the values of all others, with their standard errors.   @throws Error, FileError
  void draw(const std::filesystem::path& file, const std::string& column, bool mean = false) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hamflow
