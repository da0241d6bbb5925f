// The systems on which the drift of the energy of cg is measured, with 32 starts each, and its statistics.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/problems/pendulum.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/problems/support/polar.hpp"

namespace hamflow::drift {

inline constexpr std::uint64_t starts = 32;

struct Begin {
  std::vector<double> q, p;
  double h = 0;
};

inline double between(double a, double b, std::uint64_t start, std::uint64_t what) {
  return a + (b - a) * 0.5 * (1 + counter_uniform(17, 100 * start + what));
}

/// The arguments of both programs: [steps [system [start]]].
struct Asked {
  long steps = 0;
  std::string system{};
  int only = -1;

  explicit Asked(long all_steps) : steps(all_steps) {}
  Asked(int argc, char** argv, long default_steps) : steps(default_steps) {
    if (argc > 1) steps = static_cast<long>(std::atof(argv[1]));
    if (argc > 2) system = argv[2];
    if (argc > 3) only = std::atoi(argv[3]);
  }
  std::uint64_t first() const { return static_cast<std::uint64_t>(std::max(only, 0)); }
  std::uint64_t end() const { return only < 0 ? starts : first() + 1; }
};

template <Arithmetic A, std::size_t N>
PhasePoint<A, N> stored(const Begin& begin) {
  Vector<double, N> q{};
  Vector<double, N> p{};
  std::copy(begin.q.begin(), begin.q.end(), q.begin());
  std::copy(begin.p.begin(), begin.p.end(), p.begin());
  PhasePoint<A, N> z;
  z.store(q, p);
  return z;
}

/// H, with all digits of the compensated state.
template <class P, class A, std::size_t N>
Quad energy_of(const P& problem, const PhasePoint<A, N>& z) {
  Vector<Quad, N> q{};
  Vector<Quad, N> p{};
  for (std::size_t i = 0; i < N; ++i) {
    q[i] = Quad(z.q[i].high) + Quad(z.q[i].low);
    p[i] = Quad(z.p[i].high) + Quad(z.p[i].low);
  }
  return energy(problem, q, p);
}

struct Mean {
  double mean = 0;
  double error = 0;
};
inline Mean mean_of(const std::vector<double>& x) {
  const auto size = static_cast<double>(x.size());
  Mean m;
  for (const double v : x) m.mean += v / size;
  for (const double v : x) m.error += (v - m.mean) * (v - m.mean);
  m.error = std::sqrt(m.error / (size * (size - 1)));
  return m;
}

/// Statistics of the means of several starts.
struct Summary {
  double mean = 0;
  double error = 0;  // standard error of the mean, from the errors of the starts
  double error_of_one = 0;
  double largest = 0;    // largest |mean| of a start
  double squares = 0;    // mean of t^2 with t = mean/error; it is 1 if no start drifts
  double largest_t = 0;  // largest |t| of a start

  explicit Summary(const std::vector<Mean>& starts_in) {
    const auto count = static_cast<double>(starts_in.size());
    for (const Mean& m : starts_in) {
      mean += m.mean / count;
      error += m.error * m.error;
      error_of_one += m.error / count;
      largest = std::max(largest, std::abs(m.mean));
      if (!(m.error > 0)) continue;
      squares += m.mean * m.mean / (m.error * m.error) / count;
      largest_t = std::max(largest_t, std::abs(m.mean) / m.error);
    }
    error = std::sqrt(error) / count;
  }
};

/// A system. `made<R>()` returns the problem with number type R and constants rounded to double. `scale` is |T| + |V|
/// of a typical state. `start(s)` returns one of the 32 starts.
struct PendulumStarts {
  static constexpr const char* name = "pendulum";
  static constexpr int points = 8;
  static constexpr double scale = 1;
  template <class R>
  static Pendulum<R> made() {
    return Pendulum<R>();
  }
  /// Start 0 is the one on which a drift was found first. The others are librations of every amplitude; rotations are
  /// left out, because q and its rounding grow. Start 32 has long steps, which showed the rounding of the residual.
  static Begin start(std::uint64_t s) {
    if (s == starts) return {{0.2}, {0.05}, 0.3};
    if (s == 0) return {{2.749591}, {0.1062}, 0.0575444};
    return {{between(0.3, 2.8, s, 0)}, {between(0, 0.3, s, 1)}, between(0.03, 0.1, s, 2)};
  }
};

struct KeplerStarts {
  static constexpr const char* name = "kepler";
  static constexpr int points = 8;
  static constexpr double scale = 1;
  template <class R>
  static CentralForce<R, Kepler> made() {
    return {R(1), Kepler<R>(R(1))};
  }
  /// The ellipse r = 1 .. 3, rotated by a random angle.
  static Begin start(std::uint64_t s) {
    const double angle = s == 0 ? 0 : between(0, 2 * std::numbers::pi, s, 0);
    const double v = std::sqrt(1.5);
    return {{std::cos(angle), std::sin(angle)},
            {-v * std::sin(angle), v * std::cos(angle)},
            s == 0 ? 0.1 : between(0.05, 0.15, s, 1)};
  }
};

struct PolarStarts {
  static constexpr const char* name = "kepler-polar";
  static constexpr int points = 8;
  static constexpr double scale = 1;
  template <class R>
  static PolarCentralForce<R, Kepler> made() {
    return {R(1), Kepler<R>(R(1))};
  }
  static Begin start(std::uint64_t s) { return {{1, 0}, {0, between(1.15, 1.3, s, 0)}, between(0.05, 0.15, s, 1)}; }
};

struct HenonHeilesStarts {
  static constexpr const char* name = "henon-heiles";
  static constexpr int points = 2;
  static constexpr double scale = 0.1;
  template <class R>
  static HenonHeiles<R> made() {
    return HenonHeiles<R>();
  }
  static Begin start(std::uint64_t s) {
    return {{between(-0.3, 0.3, s, 0), between(-0.2, 0.3, s, 1)},
            {between(0, 0.3, s, 2), between(0, 0.3, s, 3)},
            between(0.05, 0.2, s, 4)};
  }
};

/// The gravity is chosen so that all constants of the problem are exact in double.
struct DoublePendulumStarts {
  static constexpr const char* name = "double-pendulum";
  static constexpr int points = 8;
  static constexpr double scale = 30;
  template <class R>
  static DoublePendulumNonlinearAbsolute<R> made() {
    return DoublePendulumNonlinearAbsolute<R>({R(1), R(1)}, {R(1), R(1)}, {R(0), R(0)}, R(9.8125));
  }
  static Begin start(std::uint64_t s) {
    return {{between(-0.8, 0.8, s, 0), between(-0.8, 0.8, s, 1)},
            {between(0, 1, s, 2), between(0, 1, s, 3)},
            between(0.005, 0.01, s, 4)};
  }
};

}  // namespace hamflow::drift
