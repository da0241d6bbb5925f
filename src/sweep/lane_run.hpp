// The members of a block on their way, with what observes them. They go together, from one step at which an observer of
// any of them is due to the next; what is seen has the bits of single runs.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "hamflow/detail/verify/lyapunov.hpp"
#include "hamflow/run/ensemble.hpp"
#include "hamflow/run/section.hpp"

namespace hamflow {

/// What observes the member of one lane.
struct LaneObservers {
  std::vector<Observer*> all{};
  std::vector<TangentWatch*> tangents{};  // those of them that follow tangent vectors
  SectionSearch* section = nullptr;
  SummedSteps* sums = nullptr;  // that of them which sums can spare the steps
};

class LaneRun {
 public:
  /// @param block loaded   @param observers of the lanes with members, equally many of each kind; empty: of none
  LaneRun(EnsembleBlock& block, std::vector<LaneObservers> observers);
  void advance(std::int64_t steps);
  /// What was summed of the steps so far goes to the observers that were spared them.
  void take_sums();
  std::int64_t taken() const { return taken_; }

 private:
  std::int64_t next_due() const;
  void call_due_observers();
  void carry_tangents();
  void look_for_sections();
  void spare_summed_steps();
  double section_distance(std::size_t lane);

  EnsembleBlock& block_;
  std::vector<LaneObservers> observers_;
  std::vector<bool> go_in_lanes_;  // of each kind of tangent vectors
  std::vector<LaneTangents> jobs_;
  bool has_sections_;
  bool has_sums_ = false;          // the block adds
  std::vector<double> distances_;  // x - value of each lane's section, at the last step
  std::int64_t taken_ = 0;
  std::int64_t due_ = 0;
  Frame frame_;
};

}  // namespace hamflow
