// The explicit methods. The hand-written loops do the operations of the method in the order of hamflow, so that all end
// states must agree in every bit; only their parameters come at run time.
#include <cmath>

#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/compositions/yoshida6.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/tableaus/rk4.hpp"
#include "library.hpp"

namespace bench {

namespace {

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
  constexpr double g1 = 1.3512071919596576340476878089714608269219993762171;
  constexpr double g2 = 1 - 2 * g1;
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
  constexpr double g1 = 0.7845136104775572638194976338663498757768;
  constexpr double g2 = 0.2355732133593581336847931829785346016865;
  constexpr double g3 = -1.177679984178871006946415680964315734639;
  constexpr double g4 = 1 - 2 * (g1 + g2 + g3);
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

template <class Recipe>
Workload workload(const Task& task, const std::string& method, HandLoop loop, int forces, const Recipe& recipe) {
  Workload w{method, task.h_text, {}, {}};
  w.contenders.push_back({"hand", [=](std::int64_t steps) { return run_hand(task, loop, forces, steps); }, {}});
  add_library_contenders(w, task, recipe, 1.05, true);
  return w;
}

}  // namespace

std::vector<Workload> explicit_workloads(const Task& task) {
  using namespace hamflow;
  return {workload(task, "verlet", hand_verlet, 1, Composition<compositions::verlet>{}),
          workload(task, "stv4", hand_stv4, 3, Composition<compositions::stv4>{}),
          workload(task, "yoshida6", hand_yoshida6, 7, Composition<compositions::yoshida6>{}),
          workload(task, "rk4", hand_rk4, 4, RungeKuttaBy<tableaus::rk4>{})};
}

}  // namespace bench
