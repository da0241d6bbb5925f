// The explicit methods. The hand-written loops do the operations of the method in the order of hamflow, so that all end
// states must agree in every bit; only their parameters come at run time. The folded loops, for information, show what
// algebra could still take off the chain of dependent operations at the price of other roundings.
#include <array>
#include <cmath>

#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/compositions/yoshida6.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/tableaus/rk4.hpp"
#include "library.hpp"

namespace bench {

namespace {

constexpr std::array<double, 1> verlet_weights{1};
constexpr std::array<double, 3> stv4_weights = [] {
  constexpr double g1 = 1.3512071919596576340476878089714608269219993762171;
  return std::array{g1, 1 - 2 * g1, g1};
}();
constexpr std::array<double, 7> yoshida6_weights = [] {
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

[[gnu::noinline]] void hand_verlet(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  Plane s = load(z);
  const double inverse_mass = 1 / mass;
  const double half = h * 0.5;
  update_force(s, k);
  for (std::int64_t i = 0; i < steps; ++i) {
    kick(s, half);
    drift(s, h, inverse_mass);
    update_force(s, k);
    kick(s, half);
  }
  save(s, z);
}

[[gnu::noinline]] void hand_stv4(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  constexpr double g1 = stv4_weights[0], g2 = stv4_weights[1];
  Plane s = load(z);
  const double inverse_mass = 1 / mass;
  const double d1 = h * g1, d2 = h * g2;
  const double c1 = h * (g1 / 2), c2 = h * ((g1 + g2) / 2);
  const auto stage = [&](double d, double c) {
    drift(s, d, inverse_mass);
    update_force(s, k);
    kick(s, c);
  };
  update_force(s, k);
  for (std::int64_t i = 0; i < steps; ++i) {
    kick(s, c1);
    stage(d1, c2);
    stage(d2, c2);
    stage(d1, c1);
  }
  save(s, z);
}

[[gnu::noinline]] void hand_yoshida6(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  constexpr double g1 = yoshida6_weights[0], g2 = yoshida6_weights[1];
  constexpr double g3 = yoshida6_weights[2], g4 = yoshida6_weights[3];
  Plane s = load(z);
  const double inverse_mass = 1 / mass;
  const double d1 = h * g1, d2 = h * g2, d3 = h * g3, d4 = h * g4;
  const double c1 = h * (g1 / 2), c2 = h * ((g1 + g2) / 2), c3 = h * ((g2 + g3) / 2), c4 = h * ((g3 + g4) / 2);
  const auto stage = [&](double d, double c) {
    drift(s, d, inverse_mass);
    update_force(s, k);
    kick(s, c);
  };
  update_force(s, k);
  for (std::int64_t i = 0; i < steps; ++i) {
    kick(s, c1);
    stage(d1, c2);
    stage(d2, c3);
    stage(d3, c4);
    stage(d4, c4);
    stage(d3, c3);
    stage(d2, c2);
    stage(d1, c1);
  }
  save(s, z);
}

/// A composition with mass, k and h in the coefficients and with the kicks at the end of one step and the beginning of
/// the next joined.
template <const auto& weights>
[[gnu::noinline]] void hand_folded(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  constexpr std::size_t stages = weights.size();
  Plane s = load(z);
  double d[stages], c[stages];
  for (std::size_t i = 0; i < stages; ++i) {
    d[i] = h * weights[i] / mass;
    c[i] = h * k * (weights[i] + weights[(i + 1) % stages]) / 2;
  }
  const auto kick_by = [&](double strength) {
    const double u = s.x * s.x + s.y * s.y;
    const double slope = strength / (u * std::sqrt(u));
    s.px -= slope * s.x;
    s.py -= slope * s.y;
  };
  kick_by(c[stages - 1] / 2);
  for (std::int64_t i = 0; i < steps; ++i) {
    for (std::size_t j = 0; j < stages; ++j) {
      s.x += d[j] * s.px;
      s.y += d[j] * s.py;
      kick_by(c[j]);
    }
  }
  kick_by(-c[stages - 1] / 2);
  save(s, z);
}

[[gnu::noinline]] void hand_rk4(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  constexpr double sixth = 1.0 / 6, third = 1.0 / 3;
  Plane s = load(z);
  const double inverse_mass = 1 / mass;
  const double half = h * 0.5;
  struct Slope {
    double x, y, px, py;
  };
  const auto slope_at = [&](double x, double y, double px, double py) -> Slope {
    const double u = x * x + y * y;
    const double slope = k / (u * std::sqrt(u));
    return {px * inverse_mass, py * inverse_mass, -(slope * x), -(slope * y)};
  };
  for (std::int64_t i = 0; i < steps; ++i) {
    const Slope a = slope_at(s.x, s.y, s.px, s.py);
    const Slope b = slope_at(s.x + half * a.x, s.y + half * a.y, s.px + half * a.px, s.py + half * a.py);
    const Slope c = slope_at(s.x + half * b.x, s.y + half * b.y, s.px + half * b.px, s.py + half * b.py);
    const Slope d = slope_at(s.x + h * c.x, s.y + h * c.y, s.px + h * c.px, s.py + h * c.py);
    s.x += h * (sixth * a.x + third * b.x + third * c.x + sixth * d.x);
    s.y += h * (sixth * a.y + third * b.y + third * c.y + sixth * d.y);
    s.px += h * (sixth * a.px + third * b.px + third * c.px + sixth * d.px);
    s.py += h * (sixth * a.py + third * b.py + third * c.py + sixth * d.py);
  }
  save(s, z);
}

using HandLoop = void (*)(Orbit&, double mass, double k, double h, std::int64_t steps);

Run run_hand(const Task& task, HandLoop loop, int forces, std::int64_t steps) {
  Run run;
  run.end = task.start;
  run.nanoseconds = timed([&] { loop(run.end, task.mass, task.k, task.h, steps); });
  run.forces = static_cast<double>(forces) * static_cast<double>(steps);
  return run;
}

/// The chain of a kick-drift-kick step runs q -> F -> p -> q: |q|^2 (two operations), its root, u sqrt(u), the
/// division, the force, the kick (two) and the drift (three); where two steps meet, two kicks follow each other.
constexpr Chain splitting_chain(int forces) { return {3 * forces + 1, 6 * forces, forces, forces}; }
/// Two of the four forces follow one another: F(q2) -> p3 -> q4 -> F(q4), and F(q1) -> p2 -> q3 -> F(q3) beside it.
constexpr Chain rk4_chain{7, 13, 2, 2};

/// @param folded may be null
template <class Recipe>
Workload workload(const Task& task, const std::string& method, int forces, const Chain& chain, HandLoop loop,
                  HandLoop folded, const Recipe& recipe) {
  Workload w{method, task.h_text, chain, {}, {}};
  w.contenders.push_back({"hand", [=](std::int64_t steps) { return run_hand(task, loop, forces, steps); }, {}});
  if (folded != nullptr) {
    w.contenders.push_back(
        {"hand, folded", [=](std::int64_t steps) { return run_hand(task, folded, forces, steps); }, "hand", 0, false});
  }
  w.bound = [=](std::int64_t steps) { return parting(task.h, 4 * forces, steps); };
  add_library_contenders(w, task, recipe, 1.05, true);
  return w;
}

}  // namespace

std::vector<Workload> explicit_workloads(const Task& task) {
  using namespace hamflow;
  return {workload(task, "verlet", 1, splitting_chain(1), hand_verlet, hand_folded<verlet_weights>,
                   Composition<compositions::verlet>{}),
          workload(task, "stv4", 3, splitting_chain(3), hand_stv4, hand_folded<stv4_weights>,
                   Composition<compositions::stv4>{}),
          workload(task, "yoshida6", 7, splitting_chain(7), hand_yoshida6, hand_folded<yoshida6_weights>,
                   Composition<compositions::yoshida6>{}),
          workload(task, "rk4", 4, rk4_chain, hand_rk4, nullptr, RungeKuttaBy<tableaus::rk4>{})};
}

}  // namespace bench
