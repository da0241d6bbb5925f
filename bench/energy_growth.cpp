// Measures how the energy error of long Kepler runs grows: the rms over 16 starts of means of H over an orbit, minus
// the first one, and the exponent c in error ~ t^c. Brouwer's law is c = 1/2.   [HairerMcLachlanRazakarivony2008]
//     energy_growth [orbits]      default 100000
// The starts differ by a rotation of the plane, which changes every rounding.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/methods/compositions/kahan_li8.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/problems/support/central_force.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace {

using namespace hamflow;
using Problem = CentralForce<double, Kepler>;
constexpr double eccentricity = 0.5;
constexpr int starts = 16;

/// H, with all stored digits of the state.
template <class S>
long double energy_of(const S& state) {
  const auto value = [](const auto& x) {
    if constexpr (requires { x.high; }) {
      return static_cast<long double>(x.high) + static_cast<long double>(x.low);
    } else {
      return static_cast<long double>(x);
    }
  };
  const long double x = value(state.q[0]);
  const long double y = value(state.q[1]);
  const long double px = value(state.p[0]);
  const long double py = value(state.p[1]);
  return (px * px + py * py) / 2 - 1 / std::sqrt(x * x + y * y);
}

/// Returns the mean of H over each of the given orbits, minus the mean over the first one. The mean removes the
/// oscillation within an orbit, which is larger but bounded.
template <class Recipe, class A>
std::vector<long double> errors_of(int start, int steps_per_orbit, const std::vector<long>& orbits) {
  const double angle = 2 * 3.14159265358979323846 * (start + 0.37) / starts;
  const double speed = std::sqrt((1 + eccentricity) / (1 - eccentricity));
  const double radius = 1 - eccentricity;
  auto run = simulate<false, Problem, Recipe, A>(
      Problem(1, Kepler<double>(1)), Recipe{}, {radius * std::cos(angle), radius * std::sin(angle)},
      {-speed * std::sin(angle), speed * std::cos(angle)}, 2 * 3.14159265358979323846 / steps_per_orbit);
  std::vector<long double> means;
  long done = 0;
  for (const long orbit : orbits) {
    if (run.advance((orbit - done) * steps_per_orbit) != Outcome::done) break;
    long double sum = 0;
    for (int i = 0; i < steps_per_orbit; ++i) {
      if (run.advance(1) != Outcome::done) return means;
      sum += energy_of(run.state());
    }
    means.push_back(sum / steps_per_orbit);
    done = orbit + 1;
  }
  for (std::size_t i = means.size(); i-- > 0;) means[i] -= means[0];
  return means;
}

template <class Recipe, class A>
void row(const char* name, int steps_per_orbit, const std::vector<long>& orbits) {
  std::vector<std::vector<long double>> all(starts);
  std::array<std::jthread, 2> workers;
  for (std::size_t w = 0; w < workers.size(); ++w) {
    workers[w] = std::jthread([&, w] {
      for (std::size_t s = w; s < starts; s += workers.size())
        all[s] = errors_of<Recipe, A>(static_cast<int>(s), steps_per_orbit, orbits);
    });
  }
  for (std::jthread& worker : workers) worker.join();
  std::printf("%-24s", name);
  std::vector<double> x, y;
  for (std::size_t k = 1; k < orbits.size(); ++k) {
    long double square = 0;
    for (const auto& errors : all) square += errors[k] * errors[k] / starts;
    const double rms = static_cast<double>(std::sqrt(square));
    if (orbits[k] >= 100) {
      x.push_back(std::log(static_cast<double>(orbits[k])));
      y.push_back(std::log(rms));
    }
    if (orbits[k] == 1000 || orbits[k] == 10000 || orbits[k] == 100000) std::printf("  %9.2e", rms);
  }
  double mx = 0, my = 0, xy = 0, xx = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    mx += x[i] / static_cast<double>(x.size()), my += y[i] / static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) xy += (x[i] - mx) * (y[i] - my), xx += (x[i] - mx) * (x[i] - mx);
  std::printf("   exponent %.2f\n", xy / xx);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const long most = argc > 1 ? std::atol(argv[1]) : 100000;
  std::vector<long> orbits{0};
  for (double k = 100; k <= 1.0001 * static_cast<double>(most); k *= std::pow(10.0, 0.125))
    orbits.push_back(std::lround(k));
  using Stv4 = Composition<compositions::stv4>;
  using KahanLi8 = Composition<compositions::kahan_li8>;
  std::printf("orbit mean of H, e = 0.5, rms over %d starts, after 10^3, 10^4, 10^5 orbits\n", starts);
  row<Stv4, Plain<double>>("stv4, 500 a orbit", 500, orbits);
  row<Stv4, Compensated<double>>("stv4, compensated", 500, orbits);
  row<KahanLi8, Plain<double>>("kahan-li8, 150 a orbit", 150, orbits);
  row<KahanLi8, Compensated<double>>("kahan-li8, compensated", 150, orbits);
}
