// **Ensemble**: many members of one problem and one method, one in each SIMD lane. Members differ in start, parameters
// and step length. Every lane has the bits of the member run alone.
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

/// The widest that this machine has.
LaneSet widest_lanes();

/// Names of the parameters that members have, and how many numbers each is.
using ParameterShape = std::vector<std::pair<std::string, std::size_t>>;

/// A member in the form that a lane needs: canonical start, parameters in the order of their shape, step length.
struct MemberStart {
  std::vector<double> q;
  std::vector<double> p;
  std::vector<double> parameters;
  double h = 0;
};

/// The result of a member.
struct MemberEnd {
  bool regular = false;  // energy and state were finite at every step; if not, the rest is undefined
  std::vector<double> q;
  std::vector<double> p;
  Excursion energy;
  std::vector<InvariantExcursion> invariants;
  std::vector<WallCount> walls;
  std::int64_t halved = 0;  // steps
};

/// Tangent vectors of a lane that wait to be carried through so many steps from a state, as StepMap does it.
struct LaneTangents {
  std::size_t lane;
  State<double>* z;
  std::vector<State<double>>* vectors;
  std::int64_t steps;
  bool carried = false;  // z and vectors are those behind the steps; if not, they are as they were
};

/// As many members as there are lanes. One virtual call advances all of them by many steps.
class EnsembleBlock {
 public:
  virtual ~EnsembleBlock() = default;
  virtual std::size_t lanes() const = 0;
  /// Lanes without a member repeat the last one. False: these members cannot run in lanes.
  virtual bool load(const ParameterShape& shape, std::span<const MemberStart> members) = 0;
  virtual void advance(std::int64_t steps) = 0;
  virtual MemberEnd look(std::size_t lane) = 0;
  /// Steps of members that were taken in lanes since load(): where steps are solved for, members may take some alone.
  virtual std::int64_t steps_in_lanes() const = 0;

  /// Whether a lane has left its program: nothing that it shows counts.
  virtual bool is_lost(std::size_t lane) const = 0;
  /// Step, time, q and p of the frame become those of a lane; nothing else of it changes.
  virtual void show(std::size_t lane, Frame& frame) const = 0;
  /// One step. The states before it stay at hand.
  virtual void take_step() = 0;
  /// The k-th number of (q, p) in every lane, behind the first step.
  virtual const double* numbers(std::size_t k) const = 0;
  /// The member as it was before the last take_step(), until the next call.
  virtual const Simulation& before_step(std::size_t lane) = 0;
  /// Before the first step: makes ready for so many tangent vectors to a lane. False: they cannot go in lanes.
  virtual bool expect_tangents(std::size_t vectors) = 0;
  /// Before the first step: from now on the values of expressions behind each step are added up, of equally many in
  /// each lane. False: this block does not.
  virtual bool expect_sums(std::span<const std::span<const NamedExpression>> /*of_lanes*/) { return false; }
  /// Over the steps of a lane.
  virtual std::vector<StepSum> sums(std::size_t /*lane*/) const { return {}; }
  /// Carries the vectors of some lanes, equally many in each, all together, with the bits of a StepMap.
  virtual void carry(std::span<LaneTangents> jobs) = 0;
};

/// Null where members of such a request cannot run in lanes: steps of the method are not recorded, or the arithmetic is
/// neither double nor compensated. load() is false where the members' steps are not the same but for constants.
std::unique_ptr<EnsembleBlock> make_ensemble_block(const Request& request, LaneSet lanes);

}  // namespace hamflow
