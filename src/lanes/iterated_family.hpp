// The programs of iterated steps with one number of points, as loops over lanes; the programs of members differ only in
// constants.
#pragma once

#include <map>
#include <set>

#include "engine/recorded_iteration.hpp"
#include "family_loop.hpp"

namespace hamflow {

class IteratedFamily {
 public:
  /// Programs of so many operations are chains enough to fill a processor with one register to a number, and with more
  /// they no longer fit into its first cache of instructions.
  explicit IteratedFamily(LaneSet lanes) : correct_(lanes, 1), finish_(lanes, 1) {}

  /// Whether enough steps are requested to be worth recording and compiling.
  bool is_worth_it(std::int64_t more_steps) { return (asked_ += more_steps) >= worth_recording; }
  /// Removes the members and keeps the loops.
  void clear() {
    recorded_.clear();
    refused_.clear();
  }
  /// Whether members with these parameters can go in lanes.
  /// @param set the number of the parameters   @param member the first of them   @return false where its step cannot be
  /// recorded or is another one
  bool take_in(std::size_t set, const IteratedMember& member);

  const RecordedIteration& recorded() const { return *recorded_.begin()->second; }
  const FamilyLoop& correct() const { return correct_; }
  const FamilyLoop& finish() const { return finish_; }
  std::size_t lanes() const { return correct_.lanes(); }
  /// The constants of members with parameters of these numbers.
  LaneNumbers constants_of_correct(std::span<const std::size_t> sets) const;
  LaneNumbers constants_of_finish(std::span<const std::size_t> sets) const;

 private:
  static constexpr std::int64_t worth_recording = 500;
  using Part = RecordedStep RecordedIteration::*;

  bool load();
  FamilyLoop::Steps steps(Part part, std::span<const std::size_t> sets) const;

  std::map<std::size_t, std::shared_ptr<const RecordedIteration>> recorded_;  // by the number of parameters
  std::set<std::size_t> refused_;
  FamilyLoop correct_;
  FamilyLoop finish_;
  std::int64_t asked_ = 0;
};

}  // namespace hamflow
