// **Ensemble**: many members of one problem and one method, one in each SIMD lane. Members differ in start, parameters
// and step size. Every lane has the bits of a separate run of its member.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/detail/numerics/lane_set.hpp"
#include "hamflow/detail/run/step_map.hpp"
#include "hamflow/detail/run/step_sums.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// The widest lanes of this machine.
LaneSet widest_lanes();

/// The names of the members' parameters, and the count of numbers of each.
using ParameterShape = std::vector<std::pair<std::string, std::size_t>>;

/// A member as input of a lane: canonical start, parameters in the order of their shape, step size.
struct MemberStart {
  std::vector<double> q;
  std::vector<double> p;
  std::vector<double> parameters;
  double h = 0;
};

/// The result of a member.
struct MemberEnd {
  bool regular = false;  // energy and state were finite at every step; otherwise the rest is undefined
  std::vector<double> q;
  std::vector<double> p;
  Excursion energy;
  std::vector<InvariantExcursion> invariants;
  std::vector<WallCount> walls;
  std::int64_t halved = 0;  // steps replaced by half steps
};

/// Tangent vectors of a lane, to be advanced by a number of steps from a state, as in StepMap.
struct LaneTangents {
  std::size_t lane;
  State<double>* z;
  std::vector<State<double>>* vectors;
  std::int64_t steps;
  bool carried = false;  // z and vectors are those after the steps; otherwise they are unchanged
};

/// One member in each lane. A virtual call advances all of them by many steps.
class EnsembleBlock {
 public:
  virtual ~EnsembleBlock() = default;
  virtual std::size_t lanes() const = 0;
  /// Lanes without a member repeat the last member. Returns false if these members cannot run in lanes.
  virtual bool load(const ParameterShape& shape, std::span<const MemberStart> members) = 0;
  virtual void advance(std::int64_t steps) = 0;
  virtual MemberEnd look(std::size_t lane) = 0;
  /// Steps taken in lanes since load(), summed over members. With implicit methods members may take some steps
  /// separately.
  virtual std::int64_t steps_in_lanes() const = 0;

  /// Whether a lane has left its program, so that its values are invalid.
  virtual bool is_lost(std::size_t lane) const = 0;
  /// Sets step, time, q and p of the frame to those of a lane, and nothing else.
  virtual void show(std::size_t lane, Frame& frame) const = 0;
  /// Takes one step. The states before it remain available.
  virtual void take_step() = 0;
  /// The k-th number of (q, p) in every lane, after the first step.
  virtual const double* numbers(std::size_t k) const = 0;
  /// The member before the last take_step(); valid until the next call.
  virtual const Simulation& before_step(std::size_t lane) = 0;
  /// Call this before the first step: prepares for the given number of tangent vectors per lane. Returns false if
  /// they cannot run in lanes.
  virtual bool expect_tangents(std::size_t vectors) = 0;
  /// Call this before the first step: from now on sums the values of expressions after each step, the same number in
  /// each lane. Returns false if this block does not support it.
  virtual bool expect_sums(std::span<const std::span<const NamedExpression>> /*of_lanes*/) { return false; }
  /// The sums over the steps of a lane.
  virtual std::vector<StepSum> sums(std::size_t /*lane*/) const { return {}; }
  /// Advances the vectors of some lanes together, the same number in each, with the bits of a StepMap.
  virtual void carry(std::span<LaneTangents> jobs) = 0;

 private:
  FunctionsInUse functions_;
};

/// Null if members of such a request cannot run in lanes: the steps of the method are not recorded, or the arithmetic
/// is neither double nor compensated. load() returns false if the members' steps differ by more than constants.
std::unique_ptr<EnsembleBlock> make_ensemble_block(const Request& request, LaneSet lanes);

}  // namespace hamflow
