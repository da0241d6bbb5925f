// Parts of the hand-written loops: the state in local variables, kicks and drifts, and weights of compositions.
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

inline constexpr std::array<double, 17> kahan_li8_weights = [] {
  constexpr std::array<double, 8> half{
      0.1302024830888900808788176320967005223572,  0.5611629817751083845619644077001505672662,
      -0.3894749626448472864080785982352483888361, 0.1588419065551556008962107457071524814121,
      -0.3959038941332375773362315393479389360268, 0.1845396409783157070918325415333754628190,
      0.2583743876863220472939791099949394718131,  0.2950117236093102988709662402182281129765};
  std::array<double, 17> all{};
  double sum = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    all[i] = all[16 - i] = half[i];
    sum += half[i];
  }
  all[8] = 1 - 2 * sum;
  return all;
}();

/// The factor of the kick after drift j, which joins the kicks of two neighbouring Verlet steps.
template <const auto& weights>
constexpr double kick_weight(std::size_t j) {
  return j + 1 < weights.size() ? (weights[j] + weights[j + 1]) / 2 : weights[j] / 2;
}

/// The state and the last kick, as local variables of a hand-written loop.
struct Plane {
  double x, y, px, py;
  double kick_x = 0, kick_y = 0;  // V'(q) times the factor of the kick
};

/// Computes the kick.   @param strength the factor of the kick times k
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
/// @param d the factor of the drift times 1/mass
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
