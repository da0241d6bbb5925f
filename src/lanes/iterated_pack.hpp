// Members that take iterated steps together, one in each lane. A lane whose iteration has converged saves its result
// until all others have. The simulation of a member takes every step that the programs or the initial guess do not
// cover.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "hamflow/detail/numerics/newton_progress.hpp"
#include "iterated_family.hpp"

namespace hamflow {

/// One member of a pack.
struct PackLane {
  std::span<double> frame;  // its present state
  Effort* effort;
  std::size_t parameters = 0;  // the number of its parameter set
};

/// Lets the member of a lane take the next step alone, from the state of its frame, and updates the frame.
/// @param left number of steps to take, including this one   @return whether the member stays in the lane
using StepAlone = std::function<bool(std::size_t lane, std::int64_t left)>;

class IteratedPack {
 public:
  /// Takes the given number of steps with each member that is still in its lane.
  /// @param lanes at most family.lanes() @return the number of steps taken in lanes
  std::int64_t run(const IteratedFamily& family, const NewtonOptions& options, bool automatic,
                   std::span<const PackLane> lanes, std::int64_t steps, const StepAlone& alone);

 private:
  /// The iteration of one lane.
  struct LaneProgress {
    NewtonProgress<double> progress{};
    int solves = 0;
    bool settled = false;
  };

  enum class Place : char { in_lane, outside, gone };  // outside: only for one step

  void start();
  void take_step();
  void solve();
  void judge(std::size_t lane);
  bool is_hidden(std::size_t lane) const;
  void keep_end(std::size_t lane);
  void take_end(std::size_t lane);
  void rest(std::size_t lane);
  void leave(std::size_t lane, const LaneNumbers& at);
  void put(std::size_t lane, std::span<const double> frame);
  void count(std::size_t lane);
  bool is_here(std::size_t lane) const { return places_[lane] == Place::in_lane; }

  double& number(std::size_t k, std::size_t lane) { return carried_[k * width_ + lane]; }
  double number(std::size_t k, std::size_t lane) const { return carried_[k * width_ + lane]; }

  const IteratedFamily* family_ = nullptr;
  const NewtonOptions* options_ = nullptr;
  IterationFrame at_;
  bool automatic_ = false;
  std::span<const PackLane> lanes_;
  std::size_t width_ = 0;
  LaneNumbers constants_of_correct_;
  LaneNumbers constants_of_finish_;
  LaneNumbers carried_;
  LaneNumbers before_;  // the numbers before the end of the step
  LaneNumbers ends_;    // saved results of lanes that wait for others: end and increment, then the state
  LaneNumbers sizes_;   // the sizes of the last corrections
  LaneNumbers totals_;
  std::vector<LaneProgress> progress_;
  std::vector<Place> places_;
  std::unique_ptr<bool[]> failed_;
  std::int64_t taken_ = 0;
};

}  // namespace hamflow
