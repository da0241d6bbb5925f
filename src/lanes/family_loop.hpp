// One loop for the steps of all members of a block. Their programs differ only in constants, which have one number per
// lane. The loop is kept for later blocks.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/recorded_step.hpp"
#include "numerics/program_lanes.hpp"

namespace hamflow {

class FamilyLoop {
 public:
  /// The step of each member, in the order of lanes; the last one is used for lanes without a member.
  using Steps = std::vector<std::shared_ptr<const RecordedStep>>;
  /// Makes a program from the program of a member. It may append constants that are the same for all members. Returns
  /// nullopt if that is impossible.
  using Make = std::function<std::optional<Program>(const Program&)>;

  /// @param registers the number of registers per value, as in make_lane_loop
  explicit FamilyLoop(LaneSet lanes, std::size_t registers = 4) : set_(lanes), registers_(registers) {}

  /// @return false if the members' steps differ in more than constants, or the program cannot be made
  bool load(const Steps& steps, const Make& make = {});
  std::size_t lanes() const { return lanes_; }
  /// @param carried the carried values of the program, lanes() numbers each, as in LaneLoop
  /// @return the number of steps taken, see LaneLoop
  std::int64_t run(LaneNumbers& carried, std::int64_t steps, std::span<bool> failed) const {
    return loop_->run(carried, constants_, steps, failed);
  }
  /// Returns the constants for another assignment of loaded members to lanes.
  LaneNumbers constants(const Steps& steps) const;
  void run(LaneNumbers& carried, const LaneNumbers& constants, std::span<bool> failed) const {
    loop_->run(carried, constants, 1, failed);
  }

 private:
  bool serves(const Program& program, const std::vector<bool>& differ) const;
  bool make_loop(const Program& program, const Make& make);

  LaneSet set_;
  std::size_t registers_;
  std::shared_ptr<const RecordedStep> first_;  // the step from which the loop was made
  std::vector<bool> differs_;                  // for each constant, whether it differs between members
  std::unique_ptr<const LaneLoop> loop_;
  std::size_t lanes_ = 0;
  LaneNumbers constants_;
};

}  // namespace hamflow
