// The programs of iterated steps with one number of quadrature points, as loops over lanes. The programs of members
// differ only in constants.
#pragma once

#include <map>
#include <set>

#include "engine/recorded_iteration.hpp"
#include "family_loop.hpp"

namespace hamflow {

class IteratedFamily {
 public:
  /// Loops use one register per value. These programs have enough independent operations to keep a processor busy, and
  /// with more registers they would not fit into the first-level instruction cache.
  explicit IteratedFamily(LaneSet lanes) : correct_(lanes, 1), finish_(lanes, 1) {}

  /// Whether enough steps are requested to be worth recording and compiling.
  bool is_worth_recording(std::int64_t more_steps) { return (asked_ += more_steps) >= worth_recording; }
  /// Removes the members and keeps the loops.
  void clear() {
    recorded_.clear();
    refused_.clear();
  }
  /// Adds members with a set of parameters.
  /// @param set the number of the set   @param member the first member with it   @return false if its step cannot be
  /// recorded, or differs in more than constants
  bool add_parameter_set(std::size_t set, const IteratedMember& member);

  const RecordedIteration& recorded() const { return *recorded_.begin()->second; }
  const FamilyLoop& correct() const { return correct_; }
  const FamilyLoop& finish() const { return finish_; }
  std::size_t lanes() const { return correct_.lanes(); }
  /// Return the constants of the programs for one parameter set per lane.
  LaneNumbers constants_of_correct(std::span<const std::size_t> sets) const;
  LaneNumbers constants_of_finish(std::span<const std::size_t> sets) const;

 private:
  static constexpr std::int64_t worth_recording = 500;
  using Part = RecordedStep RecordedIteration::*;

  bool load();
  FamilyLoop::Steps steps(Part part, std::span<const std::size_t> sets) const;

  std::map<std::size_t, std::shared_ptr<const RecordedIteration>> recorded_;  // by the number of the parameter set
  std::set<std::size_t> refused_;
  FamilyLoop correct_;
  FamilyLoop finish_;
  std::int64_t asked_ = 0;
};

}  // namespace hamflow
