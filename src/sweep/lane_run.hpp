// Advances the members of a block together with their observers, from one step at which any observer is due to the
// next. Observers see the same bits as in single runs.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "hamflow/detail/verify/lyapunov.hpp"
#include "hamflow/run/ensemble.hpp"
#include "hamflow/run/section.hpp"

namespace hamflow {

/// Observers of the member in one lane.
struct LaneObservers {
  std::vector<Observer*> all{};
  std::vector<TangentObserver*> tangents{};  // those of `all` that carry tangent vectors
  SectionSearch* section = nullptr;
  SummedSteps* sums = nullptr;  // the one of `all` that can take sums in place of steps
};

class LaneRun {
 public:
  /// @param block loaded with members   @param observers one for each lane with a member, each with the same number of
  /// every kind; empty: there are none
  LaneRun(EnsembleBlock& block, std::vector<LaneObservers> observers);
  void advance(std::int64_t steps);
  /// Passes the sums over the steps so far to the observers that were not called at them.
  void take_sums();
  std::int64_t taken() const { return taken_; }

 private:
  std::int64_t next_due() const;
  void call_due_observers();
  void advance_tangents();
  void look_for_sections();
  void use_block_sums();
  double section_distance(std::size_t lane);

  EnsembleBlock& block_;
  std::vector<LaneObservers> observers_;
  std::vector<bool> go_in_lanes_;  // for each kind of tangent vectors
  std::vector<LaneTangents> jobs_;
  bool has_sections_;
  bool has_sums_ = false;          // the block sums observables
  std::vector<double> distances_;  // x - value for the section of each lane, at the last step
  std::int64_t taken_ = 0;
  std::int64_t due_ = 0;
  Frame frame_;
};

}  // namespace hamflow
