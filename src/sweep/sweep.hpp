// Runs every member of a family of scenarios on all cores, and in SIMD lanes if problem and method allow it. The
// results are bit for bit those of single runs, for any lanes and any number of threads.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "hamflow/detail/core/archive.hpp"
#include "hamflow/detail/run/step_sums.hpp"
#include "hamflow/detail/run/sweep_shard.hpp"
#include "hamflow/detail/verify/lyapunov.hpp"
#include "hamflow/run/ensemble.hpp"
#include "hamflow/run/observer.hpp"
#include "member_names.hpp"
#include "member_reader.hpp"
#include "varied.hpp"

namespace hamflow {

/// The event that ended a member's run, and the state there.
struct MemberStop {
  std::size_t event = 0;  // index in the list of the member's events
  double t = 0;
  std::vector<double> q;
  std::vector<double> p;
  FrameDigits digits{};  // the state with all digits, in arithmetic beyond double
};

/// The result of a member. A failed member has its last good state. SweepNames has the names of the entries of the
/// lists.
struct MemberRow {
  Outcome status = Outcome::not_run;
  // the member cannot be run, because no start has the requested energy or a formula has no value
  bool no_start = false;
  std::int64_t steps = 0;
  double t = 0;
  std::vector<double> q;
  std::vector<double> p;
  FrameDigits digits;  // the state with all digits, in arithmetic beyond double
  Excursion energy;    // the scale is NaN for a map
  std::vector<InvariantExcursion> invariants;
  std::vector<double> observables;
  std::vector<WallCount> walls;
  std::vector<std::int64_t> events;         // how often each event of the member occurred
  std::vector<std::string> event_notes;     // remarks on these counts
  std::optional<MemberStop> stopped_by;     // the event that ended the run before its last step
  std::int64_t halved = 0;                  // number of halved steps
  std::vector<double> section;              // t, q and p of each point of the section
  std::vector<std::string> section_digits;  // the same with all digits, in arithmetic beyond double
  double section_residual = 0;              // largest residual of the points
  std::string section_message;              // why points may be missing
  std::string message;                      // explains a failure, or why there is no start
  // the run finished, but its energy error is so large that the result is meaningless
  bool nonsense = false;
  bool close_encounter = false;  // bodies came so close that a splitting into Kepler motions is inaccurate

  /// Name of the status in files.
  std::string status_name() const { return no_start ? "no_start" : std::string(name(status)); }
  std::size_t section_points() const { return section.size() / (1 + q.size() + p.size()); }
  /// Whether the member is finished.
  bool is_finished() const { return no_start || (status != Outcome::not_run && status != Outcome::stopped); }
  /// Archives the whole row for the checkpoint of a sweep (detail/core/archive.hpp).
  template <class Archive>
  void archive(Archive& ar);
};

/// Observes one member, alone or in a lane. In a lane, frames only contain step, time, q and p.
class MemberObserver {
 public:
  virtual ~MemberObserver() = default;
  virtual std::vector<Observer*> observers() = 0;
  /// Those observers that carry tangent vectors.
  virtual std::vector<TangentObserver*> tangents() { return {}; }
  /// The observer that only needs sums over the steps; null if there is none.
  virtual SummedSteps* sums() { return nullptr; }
  /// The results of a finished run: a number for each of MemberObservables::names.
  virtual std::vector<double> row() const = 0;
  /// How often each event of the scenario occurred, and which one ended the run.
  virtual std::vector<std::int64_t> events() const { return {}; }
  virtual std::vector<std::string> event_notes() const { return {}; }
  virtual std::optional<MemberStop> stopped_by() const { return {}; }
};

/// Advances tangent vectors to the end of a run, because an event or a failure may come before their next observation.
inline void advance_tangents_to_end(std::span<TangentObserver* const> watches, const Frame& end) {
  for (TangentObserver* watch : watches) {
    if (watch->followed() && watch->step() < end.step) (void)watch->observe(end);
  }
}

/// Further columns that are measured during the run of a member, such as an exponent.
struct MemberObservables {
  std::vector<std::string> names;
  /// Makes the observers of a member; empty: nothing is measured.   @param alone simulation of a member that runs
  /// alone; null in a lane. It and the scenario outlive the watch.
  std::function<std::unique_ptr<MemberObserver>(const Scenario&, const Simulation* alone)> watch;
};

struct SweepOptions {
  SweepShard shard{};
  int threads = 0;  // 0: all cores
  LaneSet lanes = LaneSet::none;
  /// Returns the further columns of a member. Several threads call it.
  std::function<MemberObservables(const Scenario&)> observables_of{};
  /// Asked for finished members whose energy error is larger than their scale.
  std::function<bool(const Scenario&, const MemberRow&)> is_meaningless{};
};

class Sweep {
 public:
  /// Reads and checks every member. If there are errors, complaints() lists them and the sweep cannot run.
  Sweep(const std::string& text, const std::string& name, const std::vector<std::string>& sets, Varied varied,
        SweepOptions options);

  /// Error messages, one line each, at most ten.
  const std::vector<Complaint>& complaints() const { return complaints_; }
  std::size_t members() const { return varied_.members(); }
  const Varied& varied() const { return varied_; }
  /// The row of a member. Members of other shards have the status not_run.
  const MemberRow& row(std::size_t member) const { return is_own(member) ? rows_[place(member)] : not_run_; }
  /// The rows of the members of this shard, in order.
  const std::vector<MemberRow>& own_rows() const { return rows_; }
  /// The scenario of the first member that has a start; used for settings that all members share.
  const Scenario& common() const { return common_; }
  const std::string& text() const { return text_; }
  /// Notes of the first member with a start, and notes of any member on keys of its method, because these may be
  /// varied.
  std::vector<std::string> notes() const;
  /// Names of the numbers in the rows.
  const SweepNames& names() const { return names_; }
  /// The arithmetics of the members.
  const std::set<std::string>& arithmetics() const { return arithmetics_; }
  int threads() const { return threads_; }
  LaneSet lanes() const { return in_lanes_ > 0 ? options_.lanes : LaneSet::none; }
  std::size_t lane_count() const { return lane_count_; }
  /// Number of members that run in lanes.
  std::size_t members_in_lanes() const { return in_lanes_; }
  /// Number of steps of all members together.
  std::int64_t total_steps() const { return total_steps_; }
  /// Whether a member has more digits than double.
  bool beyond_double() const { return beyond_double_; }

  /// Whether a member's method halves steps after a convergence failure.
  bool halves_steps() const { return halves_steps_; }
  /// Number of steps that a member has to take; 0 if it has no start.
  std::int64_t steps_of(std::size_t member) const { return is_own(member) ? steps_[place(member)] : 0; }
  /// Takes the row of a member of this shard that an earlier part of this sweep has finished. The member is not run
  /// again.
  void restore(std::size_t member, MemberRow row);
  /// Number of steps of the restored members.
  std::int64_t steps_before() const { return steps_before_; }
  /// Whether a member belongs to this shard.
  bool is_own(std::size_t member) const { return member % options_.shard.count == options_.shard.index; }
  const SweepShard& shard() const { return options_.shard; }
  /// Number of members of the shard.
  std::size_t own_members() const {
    return (members() + options_.shard.count - 1 - options_.shard.index) / options_.shard.count;
  }
  /// The member of row `place` of own_rows().
  std::size_t own_member(std::size_t place) const { return options_.shard.index + place * options_.shard.count; }
  /// Number of members of the shard that are not finished.
  std::size_t members_left() const;

  /// Runs all members that are not finished. Rows change meanwhile; use hold_rows() to read them.
  /// @param pulse called several times a second with the number of steps taken by all members; returns false to stop
  /// @param finished called for each finished member, by any thread, one call at a time; an exception ends the sweep
  void run(const std::function<bool(std::int64_t)>& pulse, const std::function<void(std::size_t)>& finished = {});
  /// Returns a lock. No row changes while it is held.
  [[nodiscard]] std::unique_lock<std::mutex> hold_rows() const { return std::unique_lock(rows_mutex_); }

 private:
  /// Members that can share a block.
  struct Group {
    Request request;
    ParameterShape shape;
    std::int64_t steps = 0;
    std::size_t lanes = 0;          // 0: the members run one by one
    MemberObservables observables;  // the same for all members of the group
    bool has_section = false;
    std::vector<std::size_t> members;
  };
  struct Task {
    const Group* group;
    std::size_t first;
    std::size_t count;
  };
  class Pulse;
  class Worker;

  std::size_t place(std::size_t member) const { return member / options_.shard.count; }
  std::size_t coordinates_of_first(MemberReader& reader) const;
  void read_members(const std::string& name);
  void add(std::size_t member, const Scenario& scenario);
  void keep_notes(std::size_t member, const Scenario& scenario);
  MemberObservables observables_of(const Scenario& scenario) const;
  void keep_shared_settings(std::size_t member, const Scenario& scenario);
  void refuse_different_kinds();
  void merge_names();
  void leave_without_start(std::size_t member, const Reading& reading);
  void add_complaints(std::size_t member, const Reading& reading, const std::vector<std::string>& paths);
  void put(std::size_t member, MemberRow row);
  void report(const std::map<Complaint, std::vector<std::size_t>>& found);

  Varied varied_;
  SweepOptions options_;
  SweepNames names_;
  std::set<std::string> arithmetics_;
  std::string raw_text_;
  std::string name_;
  std::vector<std::string> sets_;
  std::string text_;
  Scenario common_;
  std::map<std::string, std::size_t> method_notes_;  // each note, with the first member that has it
  std::size_t common_member_ = 0;
  std::map<std::pair<std::string, std::size_t>, std::size_t> first_of_kind_;  // first member with this problem and size
  std::optional<std::uint64_t> start_contents_;                               // hash of the start files of all members
  bool common_has_start_ = false;
  std::vector<Complaint> complaints_;
  // Of the members of this shard, at place(member): a shard of many does not keep what belongs to the others.
  std::vector<MemberStart> starts_;  // starts of the members in lanes
  std::vector<MemberRow> rows_;
  std::vector<std::int64_t> steps_;
  MemberRow not_run_;
  mutable std::mutex rows_mutex_;
  std::mutex finished_mutex_;
  std::function<void(std::size_t)> finished_;
  std::map<std::string, Group> groups_;
  std::mutex mutex_;
  std::map<Complaint, std::vector<std::size_t>> found_;  // each complaint, with its members
  int threads_ = 1;
  std::size_t in_lanes_ = 0;
  std::size_t lane_count_ = 0;
  std::int64_t total_steps_ = 0;
  std::int64_t steps_before_ = 0;
  bool beyond_double_ = false;
  bool halves_steps_ = false;
  std::atomic<bool> stop_{false};
  std::atomic<std::int64_t> steps_taken_{0};
};

template <class Archive>
void MemberRow::archive(Archive& ar) {
  const auto list = [&ar](auto& all, const auto& fields) {
    auto size = static_cast<std::uint64_t>(all.size());
    ar(size);
    if constexpr (Archive::reading) {
      if (size > ar.left()) throw Error("saved bytes end too early");
      all.resize(size);
    }
    for (auto& one : all) fields(one);
  };
  ar(status, no_start, steps, t, q, p, digits.time, digits.q, digits.p, digits.energy, digits.initial_energy);
  ar(energy.initial, energy.final, energy.max_error, energy.scale_at_start, energy.exchanged);
  list(invariants, [&ar](InvariantExcursion& one) {
    ar(one.initial, one.final, one.max_error, one.initial_digits, one.final_digits, one.max_error_digits);
  });
  ar(observables);
  list(walls, [&ar](WallCount& one) { ar(one.coordinate, one.side, one.bounces); });
  bool stopped = stopped_by.has_value();
  ar(events, event_notes, stopped);
  if (stopped) {
    if (!stopped_by) stopped_by.emplace();
    FrameDigits& all = stopped_by->digits;
    ar(stopped_by->event, stopped_by->t, stopped_by->q, stopped_by->p, all.time, all.q, all.p);
  }
  ar(halved, section, section_digits, section_residual, section_message, message);
  auto marks = static_cast<std::uint8_t>((nonsense ? 1 : 0) + (close_encounter ? 2 : 0));
  ar(marks);
  nonsense = (marks & 1) != 0;
  close_encounter = (marks & 2) != 0;
}

}  // namespace hamflow
