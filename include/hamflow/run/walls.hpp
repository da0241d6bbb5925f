// Hard and soft walls on coordinates, as a scenario describes them. They are among the choices of a request
// (Request::variant), so that whoever finds its problem finds it behind its walls.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// What happens where a coordinate meets a hard wall (docs/design.md, Walls), or that walls are terms of H.
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
  };
  std::vector<Interval> intervals;
  WallRule rule = WallRule::event;
  std::string strength = "1";  // of soft walls
  std::string exponent = "2";  // of their force
  bool hard() const { return rule != WallRule::soft; }
};

/// The walls among choices; none where there are none.
std::optional<Walls> walls_among(const std::map<std::string, std::string>& choices);
inline bool has_hard_walls(const Request& request) {
  const auto walls = walls_among(request.variant);
  return walls && walls->hard();
}
/// Puts walls among choices.
void put_among(const Walls& walls, std::map<std::string, std::string>& choices);
/// The choices without walls.
std::map<std::string, std::string> without_walls(std::map<std::string, std::string> choices);

/// One side of an interval, in the numbers of a run.
template <class R>
struct WallSide {
  std::size_t coordinate = 0;
  int side = 1;  // -1: the wall below, 1: that above
  R at{};
  /// How far beyond the wall q is; negative: inside.
  R beyond(const R& q) const { return side > 0 ? R(q - at) : R(at - q); }
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
