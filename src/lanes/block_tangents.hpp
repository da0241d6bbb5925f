// The tangent vectors of a block's members: the programs of their steps, differentiated, in lanes. Each lane has the
// bits of src/engine/recorded_tangents.hpp.
#pragma once

#include "family_loop.hpp"
#include "hamflow/run/ensemble.hpp"

namespace hamflow {

class BlockTangents {
 public:
  /// @param vectors of each lane
  BlockTangents(LaneSet lanes, std::size_t vectors) : start_(lanes), steady_(lanes), vectors_(vectors) {}

  /// @param start, steady of each member, RecordedMember::tangent_step @return false if vectors cannot run in lanes
  bool load(const FamilyLoop::Steps& start, const FamilyLoop::Steps& steady);
  void carry(std::span<LaneTangents> jobs);

 private:
  void write(const LaneTangents& job, std::size_t lane);
  void read(LaneTangents& job) const;
  /// Where slope j of vector v is among the carried.
  double* slope(std::size_t v, std::size_t j) { return carried_.data() + place(v, j); }
  std::size_t place(std::size_t v, std::size_t j) const { return (values_ + v * moving_.size() + j) * steady_.lanes(); }

  FamilyLoop start_;   // one step from a state
  FamilyLoop steady_;  // and those that follow
  std::size_t vectors_;
  std::size_t values_ = 0;
  std::vector<std::size_t> moving_;  // values whose slopes are carried; the state comes first
  LaneNumbers carried_;
};

}  // namespace hamflow
