// A sweep: every member of a family of scenarios, on all cores, one in each SIMD lane where problem and method allow.
// Results have the bits of the single runs, whatever the lanes and the number of threads.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "hamflow/run/ensemble.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/verify/lyapunov.hpp"
#include "member_reader.hpp"
#include "varied.hpp"

namespace hamflow {

/// The result of a member; of one that failed, its last good state.
struct MemberRow {
  Outcome status = Outcome::not_run;
  bool no_start = false;  // no start has the energy asked for, or a formula of it no value: it cannot be run
  std::int64_t steps = 0;
  double t = 0;
  std::vector<double> q;
  std::vector<double> p;
  FrameDigits digits;  // the same with all digits, in arithmetic beyond double
  Excursion energy;
  double energy_scale = 0;
  std::vector<InvariantExcursion> invariants;
  std::vector<double> observables;
  std::vector<WallCount> walls;
  std::vector<double> section;  // of each point of the section t, q, p
  double section_residual = 0;  // the largest
  std::string message;          // of a failure, and why there is no start
  bool nonsense = false;        // done, but its energy is off by more than it can be

  /// As it is called in files.
  std::string status_name() const { return no_start ? "no_start" : std::string(name(status)); }
  std::size_t section_points() const { return section.size() / (1 + q.size() + p.size()); }
};

/// Observes one member: alone or in a lane, where frames hold step, time, q and p and nothing else.
class MemberWatch {
 public:
  virtual ~MemberWatch() = default;
  virtual std::vector<Observer*> observers() = 0;
  /// Those of them that follow tangent vectors.
  virtual std::vector<TangentWatch*> tangents() { return {}; }
  /// The one of them that needs sums over the steps alone.
  virtual SummedSteps* sums() { return nullptr; }
  /// What was seen of a run that is done: a number for each of MemberObservables::names.
  virtual std::vector<double> row() const = 0;
};

/// Further columns, e.g. an exponent: what is seen beside the run of each member.
struct MemberObservables {
  std::vector<std::string> names;
  std::function<std::unique_ptr<MemberWatch>(const Scenario&)> watch;  // none: no columns. The scenario outlives it.
};

struct SweepOptions {
  int threads = 0;  // 0: all cores
  LaneSet lanes = LaneSet::none;
  /// Of all members, from one that has a start.
  std::function<MemberObservables(const Scenario&)> observables_of{};
  /// Asked of members that are done with an energy error above their scale.
  std::function<bool(const Scenario&, const MemberRow&)> is_nonsense{};
};

class Sweep {
 public:
  /// Reads and checks every member. Where something is wrong, complaints() lists it and nothing can be run.
  Sweep(const std::string& text, const std::string& name, const std::vector<std::string>& sets, Varied varied,
        SweepOptions options);

  /// One line each, at most ten.
  const std::vector<std::string>& complaints() const { return complaints_; }
  std::size_t members() const { return rows_.size(); }
  const Varied& varied() const { return varied_; }
  const std::vector<MemberRow>& rows() const { return rows_; }
  /// The scenario of the first member that has a start, for what all have in common.
  const Scenario& common() const { return common_; }
  const std::string& text() const { return text_; }
  const MemberObservables& observables() const { return observables_; }
  int threads() const { return threads_; }
  LaneSet lanes() const { return in_lanes_ > 0 ? options_.lanes : LaneSet::none; }
  std::size_t lane_count() const { return lane_count_; }
  /// Members that run in lanes.
  std::size_t members_in_lanes() const { return in_lanes_; }
  /// Of all members.
  std::int64_t total_steps() const { return total_steps_; }
  /// Whether a member has more digits than double.
  bool beyond_double() const { return beyond_double_; }

  /// Runs all members. @param pulse called several times a second with the steps taken by all; false stops
  void run(const std::function<bool(std::int64_t)>& pulse);

 private:
  /// Members that can share a block.
  struct Group {
    Request request;
    ParameterShape shape;
    std::int64_t steps = 0;
    std::size_t lanes = 0;  // 0: they run one by one
    std::vector<std::size_t> members;
  };
  struct Task {
    const Group* group;
    std::size_t first;
    std::size_t count;
  };
  class Worker;

  std::size_t coordinates_of_first(MemberReader& reader) const;
  void read_members(const std::string& name);
  void add(std::size_t member, const Scenario& scenario);
  void take_as_common(std::size_t member, const Scenario& scenario);
  void leave_without_start(std::size_t member, const Reading& reading);
  void add_complaints(std::size_t member, const Reading& reading, const std::vector<std::string>& paths);
  void report(const std::map<std::string, std::vector<std::size_t>>& found);

  Varied varied_;
  SweepOptions options_;
  MemberObservables observables_;
  std::string raw_text_;
  std::string name_;
  std::vector<std::string> sets_;
  std::string text_;
  Scenario common_;
  std::size_t common_member_ = 0;
  bool common_has_start_ = false;
  std::vector<std::string> complaints_;
  std::vector<MemberStart> starts_;  // of members in lanes
  std::vector<MemberRow> rows_;
  std::map<std::string, Group> groups_;
  std::mutex mutex_;
  std::map<std::string, std::vector<std::size_t>> found_;  // complaint -> members
  int threads_ = 1;
  std::size_t in_lanes_ = 0;
  std::size_t lane_count_ = 0;
  std::int64_t total_steps_ = 0;
  bool beyond_double_ = false;
  std::atomic<bool> stop_{false};
  std::atomic<std::int64_t> steps_taken_{0};
};

}  // namespace hamflow
