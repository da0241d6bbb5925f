// **Units of a state**: which numbers of a state share a unit, and how large they are along a motion. A distance
// between two states compares coordinates with coordinates and momenta with momenta, each relative to its own size, so
// that it does not depend on the units of the problem.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"
#include "hamflow/verify/long_number.hpp"

namespace hamflow {

/// Coordinates that share a unit form a group, and their momenta form another.
struct UnitGroups {
  std::vector<std::size_t> of{};    // group of each coordinate and of its momentum; empty: there is only one group
  std::vector<std::string> q{"q"};  // names of the groups of coordinates
  std::vector<std::string> p{"p"};  // names of the groups of momenta
  std::size_t count() const { return q.size(); }
  std::size_t group(std::size_t coordinate) const { return of.empty() ? 0 : of[coordinate]; }
};

/// Returns the groups of a problem with this many coordinates: angles, and all other coordinates. The units of a typed
/// H are not declared; there each coordinate is a group of its own, and so is each array x[1], x[2], ...
UnitGroups unit_groups(const ProblemEntry& problem, std::size_t size);

/// Largest |q_i| and |p_i| along a motion.
struct StateSizes {
  std::vector<double> q, p;
  void include(const std::vector<double>& at_q, const std::vector<double>& at_p);
  template <class Archive>
  void archive(Archive& ar) {
    ar(q, p);
  }
};

/// Size of each group, coordinates first, then momenta. A group that stays below 2^-40 of the largest group of its kind
/// contains only rounding errors, and this limit is taken as its size. The size is 0 if all coordinates, or all
/// momenta, are 0 along the whole motion.
struct GroupSizes {
  std::vector<double> size;
  std::vector<bool> is_rounding;  // the size of the group was below this limit
};
GroupSizes group_sizes(const UnitGroups& groups, const StateSizes& sizes);

/// Largest difference of two states within a group.
struct GroupDistance {
  std::string name;     // name of the group
  LongNumber distance;  // in the unit of the group
  double size = 0;      // size of the group along the motion
  LongNumber relative;  // distance/size; if the size is 0, the distance
};
/// Returns one distance for each group, coordinates first.
std::vector<GroupDistance> group_distances(const UnitGroups& groups, const StateSizes& sizes, const Frame& a,
                                           const Frame& b);

}  // namespace hamflow
