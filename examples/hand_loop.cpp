// hamflow beside a loop by hand: Stoermer-Verlet on a Kepler ellipse, the same bits, and how long a step takes.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/run/simulation_of.hpp"

/// q'' = -q/(2 |q|^3); the last kick of a step is the first of the next.
[[gnu::noinline]] static void by_hand(double (&z)[4], double mass, double h, long steps) {
  double x = z[0], y = z[1], px = z[2], py = z[3];
  const double d = h * (1 / mass), c = h * 0.5;
  const auto strength = [&] {
    const double u = x * x + y * y;
    return -(c / (u * std::sqrt(u)));
  };
  double w = strength();
  for (long i = 0; i < steps; ++i) {
    px += w * x, py += w * y;
    x += d * px, y += d * py;
    w = strength();
    px += w * x, py += w * y;
  }
  z[0] = x, z[1] = y, z[2] = px, z[3] = py;
}

int main() {
  using Clock = std::chrono::steady_clock;
  const hamflow::CentralForce<double, hamflow::Kepler> kepler(2.0, hamflow::Kepler<double>(1.0));
  auto orbit = hamflow::simulate<false>(kepler, hamflow::Composition<hamflow::compositions::verlet>{}, {1.0, 0.0},
                                        {0.0, std::sqrt(3.0)}, 0.1);
  double z[4] = {1.0, 0.0, 0.0, std::sqrt(3.0)};
  double best_hand = 1e9, best_hamflow = 1e9;
  constexpr long steps = 20'000;
  constexpr int rounds = 400;
  for (int round = 0; round < rounds; ++round) {  // in turns, briefly; the best of each is least disturbed
    const auto start = Clock::now();
    by_hand(z, 2.0, 0.1, steps);
    const auto between = Clock::now();
    if (orbit.advance(steps) != hamflow::Outcome::done) return 1;
    const auto end = Clock::now();
    best_hand = std::min(best_hand, std::chrono::duration<double, std::nano>(between - start).count() / steps);
    best_hamflow = std::min(best_hamflow, std::chrono::duration<double, std::nano>(end - between).count() / steps);
  }
  hamflow::Frame now;
  orbit.look(now);
  const bool same = now.q[0] == z[0] && now.q[1] == z[1] && now.p[0] == z[2] && now.p[1] == z[3];
  std::printf("by hand %.1f ns a step, hamflow %.1f ns a step: %.2f of it\n", best_hand, best_hamflow,
              best_hamflow / best_hand);
  std::printf("after %ld steps %s\n", rounds * steps, same ? "the same bits" : "NOT the same bits");
  return same ? 0 : 1;
}
