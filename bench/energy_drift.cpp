// The drift of cg's energy a step, as a fraction of |T| + |V| at the start: over 32 starts of four problems, each way
// to solve a step among them. Energies are of all the digits that are stored, in quad.
//     energy_drift [steps [problem [start]]]      steps of each start, default 10^7; in 256 blocks, whose increments
//     give the standard error of one start; that of the mean is the scatter of the starts
// A random walk of w a step hides all below w/sqrt(32 steps): 1e-22 takes 10^8 steps and hours.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/problems/pendulum.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/problems/support/polar.hpp"
#include "hamflow/verify/counter_random.hpp"

namespace {

using namespace hamflow;
using A = Compensated<double>;
constexpr std::uint64_t starts = 32;
constexpr long blocks = 256;

struct Estimate {
  double mean = 0;
  double error = 0;
};
Estimate estimate(const std::vector<double>& x) {
  const auto n = static_cast<double>(x.size());
  Estimate e;
  for (const double v : x) e.mean += v / n;
  for (const double v : x) e.error += (v - e.mean) * (v - e.mean);
  e.error = std::sqrt(e.error / (n * (n - 1)));
  return e;
}

/// H from all the digits that are stored.
template <class P, std::size_t N>
Quad energy_of(const P& problem, const PhasePoint<A, N>& z) {
  Vector<Quad, N> q{};
  Vector<Quad, N> p{};
  for (std::size_t i = 0; i < N; ++i) {
    q[i] = Quad(z.q[i].high) + Quad(z.q[i].low);
    p[i] = Quad(z.p[i].high) + Quad(z.p[i].low);
  }
  return energy(problem, q, p);
}

struct Begin {
  std::vector<double> q, p;
  double h = 0;
};
double between(double a, double b, std::uint64_t start, std::uint64_t what) {
  return a + (b - a) * 0.5 * (1 + counter_uniform(17, 100 * start + what));
}

/// @param scale |T| + |V| of a typical state of the problem   @param start_of its starts, counted
template <class P, class Q, class F>
void row(const char* name, const P& problem, const Q& in_quad, int points, double scale, F&& start_of, long steps,
         int only) {
  constexpr std::size_t n = P::dimension;
  std::vector<double> means;
  std::vector<double> errors;
  for (std::uint64_t s = 0; s < starts; ++s) {
    if (only >= 0 && s != static_cast<std::uint64_t>(only)) continue;
    const Begin from = start_of(s);
    PhasePoint<A, n> z;
    Vector<double, n> q{};
    Vector<double, n> p{};
    std::copy(from.q.begin(), from.q.end(), q.begin());
    std::copy(from.p.begin(), from.p.end(), p.begin());
    z.store(q, p);
    ContinuousGalerkin<P, A> method(problem, CgOptions{.quadrature = points});
    std::vector<double> increments;
    Quad before = energy_of(in_quad, z);
    for (long b = 0; b < blocks; ++b) {
      for (long k = 0; k < steps / blocks; ++k) {
        if (method.step(problem, from.h, z) != Outcome::done) {
          std::printf("%s: start %d failed\n", name, static_cast<int>(s));
          std::exit(1);
        }
      }
      const Quad now = energy_of(in_quad, z);
      increments.push_back(static_cast<double>(now - before) / scale / static_cast<double>(steps / blocks));
      before = now;
    }
    const Estimate one = estimate(increments);
    if (only >= 0) std::printf("%-24s start %2d   %10.2e +- %.1e\n", name, only, one.mean, one.error);
    means.push_back(one.mean);
    errors.push_back(one.error);
  }
  if (only >= 0) return;
  const Estimate all = estimate(means);
  double squares = 0;  // of t, which has the mean 1 where no start drifts
  double worst = 0;
  for (std::size_t s = 0; s < means.size(); ++s) {
    const double t = means[s] / errors[s];
    squares += t * t / static_cast<double>(starts);
    worst = std::max(worst, std::abs(t));
  }
  std::printf("%-24s %10.2e +- %.1e   one start +- %.1e   mean t^2 %6.2f   largest |t| %5.1f\n", name, all.mean,
              all.error, estimate(errors).mean, squares, worst);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const long steps = argc > 1 ? static_cast<long>(std::atof(argv[1])) : 10'000'000;
  const std::string wanted = argc > 2 ? argv[2] : "";
  const int only = argc > 3 ? std::atoi(argv[3]) : -1;
  const auto asked = [&](const char* name) { return wanted.empty() || wanted == name; };
  std::printf("energy gained a step, of the scale: mean over %d starts of %ld steps\n", static_cast<int>(starts),
              steps);
  if (asked("pendulum")) {
    // The first is the one on which a drift was found; librations of every amplitude (in a rotation q and its roundings
    // grow).
    row(
        "pendulum", Pendulum<double>(), Pendulum<Quad>(), 8, 1.0,
        [](std::uint64_t s) -> Begin {
          if (s == 0) return {{2.749591}, {0.1062}, 0.0575444};
          return {{between(0.3, 2.8, s, 0)}, {between(0, 0.3, s, 1)}, between(0.03, 0.1, s, 2)};
        },
        steps, only);
  }
  if (asked("kepler")) {
    row(
        "kepler", CentralForce<double, Kepler>(1, Kepler<double>(1)), CentralForce<Quad, Kepler>(1, Kepler<Quad>(1)), 8,
        1.0,
        [](std::uint64_t s) -> Begin {
          // The ellipse r = 1 .. 3, turned.
          const double angle = s == 0 ? 0 : between(0, 2 * std::numbers::pi, s, 0);
          const double v = std::sqrt(1.5);
          return {{std::cos(angle), std::sin(angle)},
                  {-v * std::sin(angle), v * std::cos(angle)},
                  s == 0 ? 0.1 : between(0.05, 0.15, s, 1)};
        },
        steps, only);
  }
  if (asked("kepler-polar")) {
    row(
        "kepler, polar", PolarCentralForce<double, Kepler>(1, Kepler<double>(1)),
        PolarCentralForce<Quad, Kepler>(1, Kepler<Quad>(1)), 8, 1.0,
        [](std::uint64_t s) -> Begin {
          return {{1, 0}, {0, between(1.15, 1.3, s, 0)}, between(0.05, 0.15, s, 1)};
        },
        steps, only);
  }
  if (asked("henon-heiles")) {
    row(
        "henon-heiles", HenonHeiles<double>(), HenonHeiles<Quad>(), 2, 0.1,
        [](std::uint64_t s) -> Begin {
          return {{between(-0.3, 0.3, s, 0), between(-0.2, 0.3, s, 1)},
                  {between(0, 0.3, s, 2), between(0, 0.3, s, 3)},
                  between(0.05, 0.2, s, 4)};
        },
        steps, only);
  }
  if (asked("double-pendulum")) {
    row(
        "double pendulum", DoublePendulumNonlinearAbsolute<double>(), DoublePendulumNonlinearAbsolute<Quad>(), 8, 30.0,
        [](std::uint64_t s) -> Begin {
          return {{between(-0.8, 0.8, s, 0), between(-0.8, 0.8, s, 1)},
                  {between(0, 1, s, 2), between(0, 1, s, 3)},
                  between(0.005, 0.01, s, 4)};
        },
        steps, only);
  }
}
