// The explicit methods. The hand-written loops have the operations of hamflow in the same order, so that all end states
// have to agree in every bit. Only parameters are known at run time. The folded loops are for information. They show
// how much algebra could shorten the chain of dependent operations, with other roundings.
#include "composition_loops.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/compositions/yoshida6.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/splittings/euler_a.hpp"
#include "hamflow/methods/tableaus/rk4.hpp"
#include "mclachlan.hpp"
#include "other_libraries.hpp"

namespace bench {

namespace {

[[gnu::noinline]] void hand_verlet(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  Plane s = load(z);
  const double d = h * (1 / mass);
  const double c = (h * 0.5) * k;
  find_kick(s, c);
  for (std::int64_t i = 0; i < steps; ++i) {
    kick(s);
    drift(s, d);
    find_kick(s, c);
    kick(s);
  }
  save(s, z);
}

[[gnu::noinline]] void hand_stv4(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  constexpr double g1 = stv4_weights[0], g2 = stv4_weights[1];
  Plane s = load(z);
  const double inverse_mass = 1 / mass;
  const double d1 = (h * g1) * inverse_mass, d2 = (h * g2) * inverse_mass;
  const double c1 = (h * (g1 / 2)) * k, c2 = (h * ((g1 + g2) / 2)) * k;
  const auto stage = [&](double d, double c) {
    drift(s, d);
    find_kick(s, c);
    kick(s);
  };
  find_kick(s, c1);
  for (std::int64_t i = 0; i < steps; ++i) {
    kick(s);
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
  const double d1 = (h * g1) * inverse_mass, d2 = (h * g2) * inverse_mass;
  const double d3 = (h * g3) * inverse_mass, d4 = (h * g4) * inverse_mass;
  const double c1 = (h * (g1 / 2)) * k, c2 = (h * ((g1 + g2) / 2)) * k;
  const double c3 = (h * ((g2 + g3) / 2)) * k, c4 = (h * ((g3 + g4) / 2)) * k;
  const auto stage = [&](double d, double c) {
    drift(s, d);
    find_kick(s, c);
    kick(s);
  };
  find_kick(s, c1);
  for (std::int64_t i = 0; i < steps; ++i) {
    kick(s);
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
  Plane s = load(z);
  const double sixth = h * (1.0 / 6), third = h * (1.0 / 3);
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
    s.x = s.x + (sixth * a.x + third * b.x + third * c.x) + sixth * d.x;
    s.y = s.y + (sixth * a.y + third * b.y + third * c.y) + sixth * d.y;
    s.px = s.px + (sixth * a.px + third * b.px + third * c.px) + sixth * d.px;
    s.py = s.py + (sixth * a.py + third * b.py + third * c.py) + sixth * d.py;
  }
  save(s, z);
}

/// A splitting that begins with a drift: a drift, a kick, ..., and perhaps a last drift.
template <const auto& table>
[[gnu::noinline]] void hand_drift_first(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  constexpr std::size_t count = table.size();
  Plane s = load(z);
  const double inverse_mass = 1 / mass;
  for (std::int64_t i = 0; i < steps; ++i) {
#pragma GCC unroll 16
    for (std::size_t j = 0; j + 1 < count; j += 2) {
      drift(s, (h * table[j]) * inverse_mass);
      find_kick(s, (h * table[j + 1]) * k);
      kick(s);
    }
    if constexpr (count % 2 == 1) drift(s, (h * table[count - 1]) * inverse_mass);
  }
  save(s, z);
}

/// The chain of such a splitting. Two drifts follow each other between steps, unless it ends with a kick.
constexpr Chain drift_first_chain(std::size_t actions) {
  const int forces = static_cast<int>(actions / 2);
  return {3 * forces + (actions % 2 == 1 ? 1 : 0), 4 * forces, forces, forces};
}
/// Only two of the four forces depend on each other: F(q2) -> p3 -> q4 -> F(q4), and in parallel F(q1) -> p2 -> q3 ->
/// F(q3).
constexpr Chain rk4_chain{6, 12, 2, 2};

/// @param folded may be null
template <class Recipe>
Workload workload(const Task& task, const std::string& method, int forces, const Chain& chain, HandLoop loop,
                  HandLoop folded, const Recipe& recipe) {
  Workload w = begin(task, method, forces, chain, loop);
  if (folded != nullptr) {
    w.contenders.push_back(
        {"hand, folded", [=](std::int64_t steps) { return run_hand(task, folded, forces, steps); }, "hand", 0, false});
  }
  add_library_contenders(w, task, recipe, 1.03, true);
  add_compensated_contenders(w, task);
  add_lane_contenders(w, task);
  add_other_libraries(w, task);
  return w;
}

/// A method that is not in the catalogue of hamflow, so that there is no "named" and no "watched".
template <const auto& numbers, class Recipe>
Workload drift_first(const Task& task, const std::string& method, const Recipe& recipe) {
  constexpr std::size_t actions = numbers.size();
  Workload w =
      begin(task, method, static_cast<int>(actions / 2), drift_first_chain(actions), hand_drift_first<numbers>);
  add_typed(w, task, recipe, 1.03, true);
  add_other_libraries(w, task);
  return w;
}

constexpr std::array<double, 2> euler_a_numbers{1, 1};

}  // namespace

std::vector<Workload> explicit_workloads(const Task& task) {
  using namespace hamflow;
  return {drift_first<euler_a_numbers>(task, "euler-a", SplittingBy<splittings::euler_a>{}),
          workload(task, "verlet", 1, splitting_chain(1), hand_verlet, hand_folded<verlet_weights>,
                   Composition<compositions::verlet>{}),
          workload(task, "stv4", 3, splitting_chain(3), hand_stv4, hand_folded<stv4_weights>,
                   Composition<compositions::stv4>{}),
          workload(task, "yoshida6", 7, splitting_chain(7), hand_yoshida6, hand_folded<yoshida6_weights>,
                   Composition<compositions::yoshida6>{}),
          drift_first<sb3a_m4_numbers>(task, "sb3a_m4", SplittingBy<sb3a_m4>{}),
          drift_first<sb3a_numbers>(task, "sb3a", SplittingBy<sb3a>{}),
          workload(task, "rk4", 4, rk4_chain, hand_rk4, nullptr, RungeKuttaBy<tableaus::rk4>{})};
}

}  // namespace bench
