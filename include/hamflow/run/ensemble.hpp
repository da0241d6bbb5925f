// **Ensemble**: many members of one problem and one method, one in each SIMD lane. Members differ in start, parameters
// and step length. Every lane has the bits of the member run alone.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/numerics/lane_set.hpp"
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
  double energy_scale = 0;
  std::vector<InvariantExcursion> invariants;
};

/// As many members as there are lanes. One virtual call advances all of them by many steps.
class EnsembleBlock {
 public:
  virtual ~EnsembleBlock() = default;
  virtual std::size_t lanes() const = 0;
  /// Lanes without a member repeat the last one. False: these members cannot run in lanes.
  virtual bool load(const ParameterShape& shape, std::span<const MemberStart> members) = 0;
  virtual void advance(std::int64_t steps) = 0;
  virtual MemberEnd look(std::size_t lane) const = 0;
};

/// Null where members of such a request cannot run in lanes: steps of the method are not recorded, or the arithmetic is
/// not double. load() is false where the members' steps are not the same but for constants.
std::unique_ptr<EnsembleBlock> make_ensemble_block(const Request& request, LaneSet lanes);

}  // namespace hamflow
