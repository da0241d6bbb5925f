// Measures nanoseconds per body of orbital elements from states, Kepler drifts, and states from elements (orbit_bench).
// It takes the best of many rounds over 512 different bodies, so that branches vary.
#include <chrono>
#include <cstdio>
#include <vector>

#include "hamflow/core/counter_random.hpp"
#include "hamflow/orbits/elements.hpp"
#include "hamflow/orbits/kepler_drift.hpp"
#include "hamflow/orbits/orbit.hpp"

namespace {

using Space = hamflow::Vector<double, 3>;
using Clock = std::chrono::steady_clock;

constexpr std::size_t bodies = 512;

template <class F>
void report(const char* name, F&& of_body) {
  double best = 1e300;
  double sum = 0;  // printed, so that the compiler cannot remove the computations
  for (int round = 0; round < 400; ++round) {
    const auto begin = Clock::now();
    for (std::size_t k = 0; k < bodies; ++k) sum += of_body(k);
    best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - begin).count() / bodies);
  }
  std::printf("%-34s %8.1f ns   (%g)\n", name, best, sum);
}

}  // namespace

int main() {
  std::vector<hamflow::Orbit<double>> orbits;
  std::vector<Space> r;
  std::vector<Space> v;
  for (std::uint64_t k = 0; k < bodies; ++k) {
    const auto uniform = [&](std::uint64_t part) { return (1 + hamflow::counter_uniform(1, 8 * k + part)) / 2; };
    hamflow::Orbit<double> orbit{.a = 1 + uniform(0), .e = 0.3 * uniform(1)};
    orbit.inclination = 0.2 * uniform(2);
    orbit.node = 6 * uniform(3);
    orbit.pericentre = 6 * uniform(4);
    orbit.mean_anomaly = 6 * uniform(5);
    const auto state = state_on(orbit, 1.0).value();
    orbits.push_back(orbit);
    r.push_back(state.position);
    v.push_back(state.velocity);
  }
  report("elements of a state", [&](std::size_t k) { return elements_of(r[k], v[k], 1.0).mean_longitude; });
  report("state of elements", [&](std::size_t k) { return state_on(orbits[k], 1.0)->position[0]; });
  for (const auto& [name, t] : {std::pair{"drift, 1/100 to 1/35 of a period", 0.18},
                                {"drift, a third of a period", 3.0},
                                {"drift, 1000 periods", 1e4}}) {
    report(name, [&, t = t](std::size_t k) {
      hamflow::KeplerIncrements<double, 3> add;
      const bool is_done = kepler_drift(r[k], v[k], 1.0, t, add) == hamflow::Outcome::done;
      return is_done ? add.position[0] : 0;
    });
  }
}
