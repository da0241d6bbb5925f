// Summary of a sweep as a struct. The command's output and the summary.json of the folder are made from it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/workflow/summary.hpp"

namespace hamflow {

/// Values of a varied key.
struct VariedKey {
  std::size_t count = 0;
  std::vector<std::string> values{};  // values if the key is a word; else empty
  std::optional<double> first{};      // value of the first member; nullopt: the key is a word
  std::optional<double> last{};       // value of the last member; nullopt: the key is a word
  std::string formula{};              // formula if the values follow from other keys; else empty
};

struct MemberFailure {
  std::size_t member = 0;  // index, counted from 0
  std::string kind;        // name of an Outcome, or "no_start"
  std::int64_t step = 0;   // step that failed; 0: there is no start
  double t = 0;            // time of the last good state
  std::string message;
};

/// The energy of a member.
struct MemberEnergy {
  LongNumber initial;  // in arithmetic beyond double, with all digits
  LongNumber final;
  double max_error = 0;
  double scale = 0;  // NaN: the member is a map
};

/// A member of a sweep.
struct SweepRow {
  Named<Value> varied;  // values of the varied keys
  std::string status;   // name of an Outcome, or "no_start"
  std::int64_t steps = 0;
  std::string message{};               // explains why it failed or has no start; else empty
  std::optional<StateAtTime> final{};  // nullopt: the member was not run, and all entries below are empty
  MemberEnergy energy{};
  // all invariants of the sweep; nullopt: this member does not have it
  Named<std::optional<InvariantSummary>> invariants{};
  Named<std::int64_t> events{};
  std::vector<std::string> event_notes{};
  std::optional<StopSummary> stopped_by{};
  Named<double> columns{};  // measured numbers, named as in the sweep's table; NaN: unknown
  std::vector<ObservableSummary> observables{};
  std::optional<SectionSummary> section{};
};

/// The results of a sweep.
struct SweepSummary {
  static constexpr std::size_t most_rows = 10000;

  std::string status;  // "done", "interrupted"; "failed": no member finished
  // The same for all members; nullopt: the key is varied.
  std::optional<std::string> problem;
  std::optional<std::string> arithmetic;
  std::size_t members = 0;  // of the shard, if the sweep has shards
  std::string shard{};      // "3/64"; empty: the whole sweep
  std::size_t done = 0;
  std::size_t failed = 0;
  std::size_t unfinished = 0;
  std::size_t no_start = 0;  // number of failed members without a start
  Named<VariedKey> varied{};
  double wall_seconds = 0;
  double member_steps_per_second = 0;
  double members_per_second = 0;
  std::string instruction_set{};     // instruction set of the lanes
  std::size_t lanes = 1;             // members in one SIMD register
  std::size_t members_in_lanes = 0;  // the other members run one by one
  std::string note{};                // explains why no member runs in lanes; else empty
  int threads = 1;
  std::vector<Warning> warnings{};
  std::optional<std::size_t> section_points{};  // of all members together; nullopt: no section is requested
  std::vector<MemberFailure> failures{};        // at most the first ten
  // one for each member; empty if a folder has the table, or for more than most_rows members
  std::vector<SweepRow> rows{};
};

/// Returns the text of summary.json.   @param with_rows false: without rows
std::string sweep_json(const SweepSummary& summary, bool with_rows);
/// Returns the summary as text, one line for each entry.
std::string sweep_text(const SweepSummary& summary);

}  // namespace hamflow
