// eg(k): its definition, lambda as it is written, solved by another iteration in twice the digits; energy and momenta;
// orders; rest, circles and what is close to them.
#include "hamflow/methods/eg.hpp"

#include "../support/near.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/problems/of_any_size/n_body.hpp"
#include "hamflow/problems/potentials/binomial.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "mutants/examine.hpp"

namespace hamflow {
namespace {

template <class R>
using KeplerPlane = CentralForce<R, Kepler>;
using Plane = KeplerPlane<double>;
static_assert(StepEquations<RadialCollocation<Plane, double>>);
static_assert(RadialForces<NBody<double>> && RadialForces<Plane>);
static_assert(!RadialForces<HenonHeiles<double>> && !RadialForces<Pendulum<double>>);

/// Gauss collocation as a table a, b.   [HLW2006, table II.1.1]
template <class R>
struct Butcher {
  std::vector<std::vector<R>> a;
  std::vector<R> b;
  explicit Butcher(int k) {
    const R three = sqrt(R(3)) / R(6);
    const R five = sqrt(R(15));
    const R q = R(1) / R(36);
    if (k == 1) a = {{R(1) / R(2)}}, b = {R(1)};
    if (k == 2) {
      a = {{R(1) / R(4), R(1) / R(4) - three}, {R(1) / R(4) + three, R(1) / R(4)}};
      b = {R(1) / R(2), R(1) / R(2)};
    }
    if (k == 3) {
      a = {{R(5) * q, R(2) / R(9) - five / R(15), R(5) * q - five / R(30)},
           {R(5) * q + five / R(24), R(2) / R(9), R(5) * q - five / R(24)},
           {R(5) * q + five / R(30), R(2) / R(9) + five / R(15), R(5) * q}};
      b = {R(5) / R(18), R(4) / R(9), R(5) / R(18)};
    }
  }
};

/// Bodies in the plane under V = -sum w_a w_b/sqrt(r^2 + s^2): a step of the definition, in R, by fixed-point
/// iteration.
/// @param inverse 1/m; 0 of a body that is the centre
template <class R>
std::vector<R> defined(int k, const std::vector<R>& w, const std::vector<R>& inverse, const R& softening,
                       const std::vector<R>& z0, const R& h) {
  const Butcher<R> table(k);
  const std::size_t n = 2 * w.size();
  const auto stages = static_cast<std::size_t>(k);
  std::vector<std::vector<R>> f(stages, std::vector<R>(n, R(0)));
  const auto phi = [&](const R& u) { return R(-1) / sqrt(u + softening * softening); };
  const auto slope = [&](const R& u) {
    return R(1) / (R(2) * (u + softening * softening) * sqrt(u + softening * softening));
  };
  std::vector<R> z1 = z0;
  for (int pass = 0; pass < 300; ++pass) {
    std::vector<std::vector<R>> v(stages, std::vector<R>(n)), x(stages, std::vector<R>(n));
    for (std::size_t l = 0; l < stages; ++l) {
      for (std::size_t i = 0; i < n; ++i) {
        R p = z0[n + i];
        for (std::size_t j = 0; j < stages; ++j) p += h * table.a[l][j] * f[j][i];
        v[l][i] = p * inverse[i / 2];
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      z1[i] = z0[i];
      z1[n + i] = z0[n + i];
      for (std::size_t l = 0; l < stages; ++l) {
        x[l][i] = z0[i];
        for (std::size_t j = 0; j < stages; ++j) x[l][i] += h * table.a[l][j] * v[j][i];
        z1[i] += h * table.b[l] * v[l][i];
        z1[n + i] += h * table.b[l] * f[l][i];
      }
    }
    for (auto& row : f) row.assign(n, R(0));
    for (std::size_t a = 0; a < n; a += 2) {
      for (std::size_t b = a + 2; b < n; b += 2) {
        const auto square = [&](const std::vector<R>& y) {
          return (y[a] - y[b]) * (y[a] - y[b]) + (y[a + 1] - y[b + 1]) * (y[a + 1] - y[b + 1]);
        };
        R over = phi(square(z1)) - phi(square(z0));
        R under(0);
        std::vector<R> rate(stages);
        for (std::size_t l = 0; l < stages; ++l) {
          rate[l] = R(2) * ((x[l][a] - x[l][b]) * (v[l][a] - v[l][b]) +
                            (x[l][a + 1] - x[l][b + 1]) * (v[l][a + 1] - v[l][b + 1]));
          over -= h * table.b[l] * slope(square(x[l])) * rate[l];
          under += h * table.b[l] * rate[l] * rate[l];
        }
        for (std::size_t l = 0; l < stages; ++l) {
          const R factor = R(-2) * w[a / 2] * w[b / 2] * (slope(square(x[l])) + over / under * rate[l]);
          for (std::size_t d = 0; d < 2; ++d) {
            f[l][a + d] += factor * (x[l][a + d] - x[l][b + d]);
            f[l][b + d] -= factor * (x[l][a + d] - x[l][b + d]);
          }
        }
      }
    }
  }
  return z1;
}

template <class R>
NBody<R> bodies() {
  return NBody<R>(Parameters<R>({{"masses", "[1, 0.3, 0.2]"}, {"gravitational_constant", "1"}, {"softening", "0.2"}}),
                  6);
}
constexpr double positions[6] = {0, 0, 1, 0, 0.125, -1.5};
constexpr double momenta[6] = {0, -0.125, 0.0625, 0.3125, 0.1875, 0};
template <class R>
Vector<R, dynamic> state(const double (&x)[6]) {
  Vector<R, dynamic> y(6);
  for (std::size_t i = 0; i < 6; ++i) y[i] = R(x[i]);
  return y;
}
EgOptions degree(int k) { return {.degree = k}; }

template <class R>
void expect_near(const R& found, const Mp& exact, double bound, const char* what, std::size_t i) {
  EXPECT_LE(std::fabs(static_cast<double>(Mp(found) - exact)), bound) << what << ' ' << i;
}
template <class R>
void expect_defined(int k, double bound) {
  auto simulation = simulate(bodies<R>(), Eg{degree(k)}, state<R>(positions), state<R>(momenta), R(0.0625));
  ASSERT_EQ(simulation.advance(1), Outcome::done) << simulation.failure();
  const auto q = simulation.state().positions();
  const auto p = simulation.state().momenta();
  const MpDigits scope(60);
  std::vector<Mp> z0;
  for (const double x : positions) z0.push_back(Mp(x));
  for (const double x : momenta) z0.push_back(Mp(x));
  // The masses are those that the problem has, in R.
  const std::vector<Mp> m{Mp(1), Mp(R(3) / R(10)), Mp(R(1) / R(5))};
  const auto exact = defined<Mp>(k, m, {Mp(1) / m[0], Mp(1) / m[1], Mp(1) / m[2]}, Mp(R(1) / R(5)), z0, Mp(0.0625));
  for (std::size_t i = 0; i < 6; ++i) {
    expect_near(q[i], exact[i], bound, "q", i);
    expect_near(p[i], exact[6 + i], bound, "p", i);
  }
}
TEST(Eg, IsItsDefinition) {
  for (int k = 1; k <= 3; ++k) {
    expect_defined<double>(k, 8 * test::epsilon);  // some ten roundings of numbers of size 1 and below
    const MpDigits scope(40);
    expect_defined<Mp>(k, 1e-38);
  }
}

/// On Kepler's ellipses the literal lambda, and nothing else: the guard of circles must not be felt anywhere along the
/// orbit, not where u' changes its sign in the middle of a step either.
TEST(Eg, IsItsDefinitionAlongEllipses) {
  struct Orbit {
    double e;
    int steps;  // to a period
  };
  const double pi = 3.141592653589793;
  for (const auto& [e, steps] : {Orbit{0.6, 21}, {0.6, 63}, {0.1, 40}, {0.01, 63}, {0.001, 200}}) {
    const double h = 2 * pi / steps;
    for (int k = 1; k <= 3; ++k) {
      // From the pericentre, with it and the apocentre in the middle of the step, and from between.
      for (const double anomaly : {0.0, -h / (1 - e) / 2, pi - h / (1 + e) / 2, 1.2, 2.4, 4.0}) {
        const double n = 1 - e * std::cos(anomaly);
        const double b = std::sqrt(1 - e * e);
        const Vector<double, 2> q{std::cos(anomaly) - e, b * std::sin(anomaly)};
        const Vector<double, 2> p{-std::sin(anomaly) / n, b * std::cos(anomaly) / n};
        auto simulation = simulate(Plane(1.0, Kepler<double>(1.0)), Eg{degree(k)}, q, p, h);
        ASSERT_EQ(simulation.advance(1), Outcome::done) << simulation.failure();
        const MpDigits scope(40);
        const auto exact = defined<Mp>(k, {Mp(1), Mp(1)}, {Mp(1), Mp(0)}, Mp(0),
                                       {Mp(q[0]), Mp(q[1]), Mp(0), Mp(0), Mp(p[0]), Mp(p[1]), Mp(0), Mp(0)}, Mp(h));
        // Roundings of numbers of size 2, which lambda u' rounds by as much as they by u'.
        for (std::size_t i = 0; i < 2; ++i) {
          SCOPED_TRACE(testing::Message() << "eg(" << k << "), e = " << e << ", from " << anomaly);
          expect_near(simulation.state().positions()[i], exact[i], 32 * test::epsilon, "q", i);
          expect_near(simulation.state().momenta()[i], exact[4 + i], 32 * test::epsilon, "p", i);
        }
      }
    }
  }
}

TEST(Eg, KeepsEnergyAndMomenta) {
  for (int k = 1; k <= 3; ++k) {
    auto simulation = simulate(bodies<double>(), Eg{degree(k)}, state<double>(positions), state<double>(momenta), 0.02);
    ASSERT_EQ(simulation.advance(10000), Outcome::done) << simulation.failure();
    // A walk of roundings of terms of size 1, of 30 numbers a step.
    const double bound = 30 * std::sqrt(10000) * test::epsilon;
    EXPECT_LE(simulation.energy().max_error, bound) << k;
    const auto kept = simulation.invariants();
    for (std::size_t i = 0; i < 2; ++i) EXPECT_LE(kept[i].max_error, bound) << k << ' ' << i;
    EXPECT_LE(simulation.effort().solves_max, 4);
  }
}

/// What twice the steps change at t = 1, in quad.
double distance(int k, int steps, const Quad& x, const Quad& v) {
  const CentralForce<Quad, Kepler> problem(Quad(1), Kepler<Quad>(Quad(1)));
  const auto end = [&](int n) {
    auto simulation = simulate(problem, Eg{degree(k)}, {Quad(1), Quad(0)}, {x, v}, Quad(1) / Quad(n));
    EXPECT_EQ(simulation.advance(n), Outcome::done);
    return simulation.state().positions();
  };
  const auto a = end(steps);
  const auto b = end(2 * steps);
  return static_cast<double>(abs(a[0] - b[0]) + abs(a[1] - b[1]));
}
TEST(Eg, HasOrderTwiceItsDegree) {
  for (int k = 1; k <= 3; ++k) {
    // Near a circle, where the guard hands over to lambda as the step becomes shorter, and on one.
    for (const auto& [x, v] : {std::pair{0.125, 1.125}, {0.0, 1 + 0x1p-10}, {0.0, 1.0}}) {
      const double slope = std::log2(distance(k, 16, Quad(x), Quad(v)) / distance(k, 64, Quad(x), Quad(v))) / 2;
      EXPECT_NEAR(slope, 2 * k, 0.1) << k << ' ' << x << ' ' << v;
    }
  }
}

TEST(Eg, OnACircleAndCloseToOne) {
  // The projection on u' has no limit there: without the guard steps of 21 to a round have no solution.
  for (int k = 1; k <= 3; ++k) {
    for (const double h : {0.02, 0.1, 0.3}) {
      for (const double off : {0.0, 1e-13, 1e-9, 1e-7, 1e-5, 1e-3}) {
        auto simulation = simulate(Plane(1.0, Kepler<double>(1.0)), Eg{degree(k)}, {1.0, 0.0}, {0.0, 1.0 + off}, h);
        ASSERT_EQ(simulation.advance(200), Outcome::done) << k << ' ' << h << ' ' << off << simulation.failure();
        EXPECT_LE(simulation.energy().max_error, 8 * std::sqrt(200) * test::epsilon) << k << ' ' << h << ' ' << off;
        EXPECT_LE(simulation.effort().solves_max, 7) << k << ' ' << h << ' ' << off;
        const double r = std::hypot(simulation.state().q[0].high, simulation.state().q[1].high);
        if (off == 0) {
          // A circle has the least energy of its angular momentum: an error dE is an eccentricity of sqrt(2 dE).
          EXPECT_NEAR(r, 1, std::sqrt(2 * 8 * std::sqrt(200) * test::epsilon)) << "a circle stays one";
        }
      }
    }
  }
}

TEST(Eg, AtRestAndOnALine) {
  for (int k = 1; k <= 3; ++k) {
    auto fall = simulate(Plane(1.0, Kepler<double>(1.0)), Eg{degree(k)}, {1.0, 0.5}, {0.0, 0.0}, 0.01);
    ASSERT_EQ(fall.advance(50), Outcome::done) << fall.failure();
    EXPECT_LE(fall.energy().max_error, 64 * test::epsilon);
    // r = 1 is the minimum of the binomial potential: at rest for ever.
    auto still = simulate(CentralForce<double, Binomial>(1.0, Binomial<double>(1000.0, 1.0)), Eg{degree(k)}, {1.0, 0.0},
                          {0.0, 0.0}, 0.1);
    ASSERT_EQ(still.advance(50), Outcome::done) << still.failure();
    EXPECT_EQ(still.state().positions(), (Vector<double, 2>{1, 0}));
  }
}

TEST(Eg, FixedPointsAndOldTangentsSolveTheSameEquations) {
  for (const Iteration iteration : {Iteration::simplified, Iteration::fixed_point}) {
    EgOptions options = degree(2);
    auto newton = simulate(bodies<double>(), Eg{options}, state<double>(positions), state<double>(momenta), 0.02);
    options.iteration = iteration;
    options.max_iterations = 100;
    auto other = simulate(bodies<double>(), Eg{options}, state<double>(positions), state<double>(momenta), 0.02);
    ASSERT_EQ(newton.advance(20), Outcome::done);
    ASSERT_EQ(other.advance(20), Outcome::done) << other.failure();
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(newton.state().q[i].high, other.state().q[i].high, 20 * 20 * 8 * test::epsilon);
    }
  }
}

TEST(Eg, IsDifferentiatedExactlyWhereTheGuardActs) {
  // Starts with rho from below 2 to above 8: the Jacobian of the step, from its equations, beside divided differences,
  // whose truncation d^2 Psi'''/6 is 1e-9: the guard changes over eccentricities of 1e-3, so that Psi''' reaches 1e8.
  const StepMapOf<KeplerPlane, Eg> map([]<class R>() { return KeplerPlane<R>(R(1), Kepler<R>(R(1))); }, Eg{degree(2)});
  constexpr double h = 0.3;
  constexpr long double d = 0x1p-27L;
  for (const double off : {1e-5, 3e-4, 5e-4, 1e-3, 2e-3, 1e-2}) {
    const State<double> z{1, 0, 0, 1 + off};
    const auto exact = map.jacobian(z, h);
    for (std::size_t j = 0; j < 4; ++j) {
      State<long double> plus(z.begin(), z.end());
      State<long double> minus = plus;
      plus[j] += d;
      minus[j] -= d;
      ASSERT_TRUE(map.advance(plus, static_cast<long double>(h), 1));
      ASSERT_TRUE(map.advance(minus, static_cast<long double>(h), 1));
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(exact[i][j], static_cast<double>((plus[i] - minus[i]) / (2 * d)), 1e-8) << off << i << j;
      }
    }
  }
}

// That eg(k) is what it claims to be is measured with the catalogue (claims_test.cpp).
TEST(Eg, WithoutLambdaIsCaught) {
  // eg(2) without lambda is Gauss collocation.
  const StepMapOf<KeplerPlane, Gauss> map([]<class R>() { return KeplerPlane<R>(R(1), Kepler<R>(R(1))); },
                                          Gauss{{.stages = 2}});
  const Region region = region_of("central-force", {{"potential", "kepler"}, {"coordinates", "cartesian"}});
  EXPECT_EQ(measure_energy(map, region).conserving(describe(degree(2)).order), Conservation::no);
}

}  // namespace
}  // namespace hamflow
