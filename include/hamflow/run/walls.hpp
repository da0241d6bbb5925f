// Hard and soft walls on coordinates, as a scenario and a request describe them.
#pragma once

#include <compare>
#include <string>
#include <vector>

#include "hamflow/core/math.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/detail/core/option_info.hpp"

namespace hamflow {

/// What happens where a coordinate meets a hard wall (docs/design/walls.md), or that walls are terms of H.
enum class WallRule { event, mirror, reject, soft };
/// Their names, in this order.
const std::vector<std::string>& wall_rules();

/// The keys of [problem] for them, and those of each entry of `walls`.
struct WallKeys {
  OptionInfo walls, wall_rule, strength, exponent;
  OptionInfo coordinate, min, max;
};
const WallKeys& wall_keys();

struct Walls {
  struct Interval {
    std::string coordinate;  // its name
    std::size_t index = 0;   // among the coordinates
    std::string min;         // number expressions; empty: no wall on that side
    std::string max;
    friend auto operator<=>(const Interval&, const Interval&) = default;
  };
  std::vector<Interval> intervals;
  WallRule rule = WallRule::event;
  std::string strength = "1";  // of soft walls
  std::string exponent = "2";  // of their force
  bool hard() const { return rule != WallRule::soft; }
  friend auto operator<=>(const Walls&, const Walls&) = default;
};

/// One side of an interval, in the numbers of a run.
template <class R>
struct WallSide {
  std::size_t coordinate = 0;
  int side = 1;  // -1: the wall below, 1: that above
  R at{};
  /// How far beyond the wall q is; negative: inside.
  /// @tparam S R, or a recording of it
  template <class S>
  S beyond(const S& q) const {
    return side > 0 ? S(q - S(at)) : S(S(at) - q);
  }
  /// Above 0 where the motion may have been beyond the wall between two points that are inside: one that turns once
  /// between them has not been where it would still be inside after two steps of the same velocity from either end.
  /// @param ahead, behind the change of the coordinate in two steps, from the first point and to the second one
  template <class S>
  S beyond_between(const S& q0, const S& ahead, const S& q1, const S& behind) const {
    return -larger(S(-beyond(S(q0 + ahead))), S(-beyond(S(q1 - behind))));
  }
};
template <class R>
std::vector<WallSide<R>> wall_sides(const Walls& walls) {
  std::vector<WallSide<R>> sides;
  for (const Walls::Interval& interval : walls.intervals) {
    if (!interval.min.empty()) sides.push_back({interval.index, -1, evaluate_number<R>(interval.min)});
    if (!interval.max.empty()) sides.push_back({interval.index, 1, evaluate_number<R>(interval.max)});
  }
  return sides;
}

/// Where walls of the lattice stand: on the nearest odd multiple of half a unit, so that no position is on a wall and a
/// reflection is one-to-one.
double on_half_lattice(double wall, double unit);

}  // namespace hamflow
