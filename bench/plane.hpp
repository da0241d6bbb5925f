// What the hand-written loops share: the state in locals, the actions, and the weights of the compositions.
#pragma once

#include <array>
#include <cmath>

#include "library.hpp"

namespace bench {

inline constexpr std::array<double, 1> verlet_weights{1};
inline constexpr std::array<double, 3> stv4_weights = [] {
  constexpr double g1 = 1.3512071919596576340476878089714608269219993762171;
  return std::array{g1, 1 - 2 * g1, g1};
}();
inline constexpr std::array<double, 7> yoshida6_weights = [] {
  constexpr double g1 = 0.7845136104775572638194976338663498757768;
  constexpr double g2 = 0.2355732133593581336847931829785346016865;
  constexpr double g3 = -1.177679984178871006946415680964315734639;
  return std::array{g1, g2, g3, 1 - 2 * (g1 + g2 + g3), g3, g2, g1};
}();

/// The state and the last kick of a hand-written loop, in locals of the loop's function.
struct Plane {
  double x, y, px, py;
  double kick_x = 0, kick_y = 0;  // V'(q) times the factor of the kick
};

/// @param strength factor of the kick times k
inline void find_kick(Plane& s, double strength) {
  const double u = s.x * s.x + s.y * s.y;
  const double slope = strength / (u * std::sqrt(u));
  s.kick_x = slope * s.x;
  s.kick_y = slope * s.y;
}
inline void kick(Plane& s) {
  s.px -= s.kick_x;
  s.py -= s.kick_y;
}
/// @param d factor of the drift times 1/mass
inline void drift(Plane& s, double d) {
  s.x += d * s.px;
  s.y += d * s.py;
}
inline Plane load(const Orbit& z) { return {z.q[0], z.q[1], z.p[0], z.p[1]}; }
inline void save(const Plane& s, Orbit& z) { z = {{s.x, s.y}, {s.px, s.py}}; }

using HandLoop = void (*)(Orbit&, double mass, double k, double h, std::int64_t steps);

inline Run run_hand(const Task& task, HandLoop loop, int forces, std::int64_t steps) {
  Run run;
  run.end = task.start;
  run.nanoseconds = timed([&] { loop(run.end, task.mass, task.k, task.h, steps); });
  run.forces = static_cast<double>(forces) * static_cast<double>(steps);
  return run;
}

}  // namespace bench
