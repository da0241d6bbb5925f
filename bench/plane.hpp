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

/// The state and force of a hand-written loop, in locals of the loop's function.
struct Plane {
  double x, y, px, py;
  double fx = 0, fy = 0;  // V'(q)
};

inline void update_force(Plane& s, double k) {
  const double u = s.x * s.x + s.y * s.y;
  const double slope = k / (u * std::sqrt(u));
  s.fx = slope * s.x;
  s.fy = slope * s.y;
}
inline void kick(Plane& s, double c) {
  s.px -= c * s.fx;
  s.py -= c * s.fy;
}
inline void drift(Plane& s, double d, double inverse_mass) {
  s.x += d * (s.px * inverse_mass);
  s.y += d * (s.py * inverse_mass);
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
