// Tangent vectors of the members of a block: the differentiated programs of their steps, in lanes. Each lane has the
// bits of src/engine/recorded_tangents.hpp.
#pragma once

#include "family_loop.hpp"
#include "hamflow/run/ensemble.hpp"

namespace hamflow {

class BlockTangents {
 public:
  /// @param vectors the number of vectors of each lane
  BlockTangents(LaneSet lanes, std::size_t vectors) : start_(lanes), steady_(lanes), vectors_(vectors) {}

  /// @param start, steady for each member, the steps of RecordedMember::tangent_step
  /// @return false if vectors cannot run in lanes
  bool load(const FamilyLoop::Steps& start, const FamilyLoop::Steps& steady);
  void carry(std::span<LaneTangents> jobs);

 private:
  void write(const LaneTangents& job, std::size_t lane);
  void read(LaneTangents& job) const;
  /// Returns the place of slope j of vector v among the carried values.
  double* slope(std::size_t v, std::size_t j) { return carried_.data() + place(v, j); }
  std::size_t place(std::size_t v, std::size_t j) const { return (values_ + v * moving_.size() + j) * steady_.lanes(); }

  FamilyLoop start_;   // the first step from a state
  FamilyLoop steady_;  // the steps after it
  std::size_t vectors_;
  std::size_t values_ = 0;
  std::vector<std::size_t> moving_;  // the values whose slopes are carried, the state first
  LaneNumbers carried_;
};

}  // namespace hamflow
