// Hand-written loops for compositions with many stages: two arrays contain the factors, already multiplied by h, mass
// and k, and the loop over the stages is unrolled.
#pragma once

#include "plane.hpp"

namespace bench {

/// The factors of the kicks and drifts of one step.
template <const auto& weights>
struct Factors {
  static constexpr std::size_t stages = weights.size();
  double d[stages], c[stages];
  Factors(double inverse_mass, double k, double h) {
    for (std::size_t j = 0; j < stages; ++j) {
      d[j] = (h * weights[j]) * inverse_mass;
      c[j] = (h * kick_weight<weights>(j)) * k;
    }
  }
};

/// The operations of hamflow in the same order. The last kick of a step is kept for the next one.
template <const auto& weights>
[[gnu::noinline]] void hand_table(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  const Factors<weights> factors(1 / mass, k, h);
  Plane s = load(z);
  find_kick(s, factors.c[factors.stages - 1]);
  for (std::int64_t i = 0; i < steps; ++i) {
    kick(s);
#pragma GCC unroll 20
    for (std::size_t j = 0; j < factors.stages; ++j) {
      drift(s, factors.d[j]);
      find_kick(s, factors.c[j]);
      kick(s);
    }
  }
  save(s, z);
}

/// A composition that joins the last kick of a step with the first kick of the next one.
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

/// The longest chain of a kick-drift-kick step goes q -> F -> p -> q: |q|^2 (two operations), the square root, u
/// sqrt(u), the division, the increment of p, the kick and the drift (two). Between two steps one more kick adds to it.
constexpr Chain splitting_chain(int forces) { return {3 * forces + 1, 4 * forces, forces, forces}; }

inline Workload begin(const Task& task, const std::string& method, int forces, const Chain& chain, HandLoop loop) {
  Workload w{method, task.h_text, chain, {}, {}};
  w.contenders.push_back({"hand", [=](std::int64_t steps) { return run_hand(task, loop, forces, steps); }, {}});
  w.bound = [=](std::int64_t steps) { return parting(task.h, 4 * forces, steps); };
  return w;
}

}  // namespace bench
