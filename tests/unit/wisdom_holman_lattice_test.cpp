// wisdom-holman on the lattice: every bit returns, the shears of a Kepler drift are one to rounding, and the motion is
// that of the same method in floating point.
#include "hamflow/methods/wisdom_holman_lattice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/methods/wisdom_holman_step.hpp"
#include "hamflow/orbits/bodies.hpp"
#include "hamflow/orbits/kepler_drift.hpp"
#include "hamflow/problems/of_any_size/n_body.hpp"

namespace hamflow {
namespace {

using P = NBody<double>;
const WisdomHolmanOptions heliocentric{.coordinates = WisdomHolmanCoordinates::heliocentric};

/// A star and planets, whose centre of mass moves.
struct System {
  std::vector<double> masses;
  std::vector<double> q;
  std::vector<double> p;

  P problem() const {
    Parameters<double> parameters;
    parameters.set_list("masses", masses);
    parameters.set("gravitational_constant", 1);
    parameters.set("softening", 0);
    return P(parameters, q.size());
  }
  template <class A>
  PhasePoint<A, dynamic> start(A arithmetic = {}) const {
    PhasePoint<A, dynamic> z;
    z.arithmetic = arithmetic;
    Vector<double, dynamic> x(q.size());
    Vector<double, dynamic> y(q.size());
    std::copy(q.begin(), q.end(), x.begin());
    std::copy(p.begin(), p.end(), y.begin());
    z.store(x, y);
    return z;
  }
};

System planets(double largest_e, std::size_t count = 8, bool with_dust = false) {
  std::mt19937 random(46);
  std::uniform_real_distribution<double> unit(0, 1);
  System system{{1}, {}, {}};
  std::vector<BodyStart<double>> given{{.mass = 1}};
  for (std::size_t i = 0; i < count; ++i) {
    Orbit<double> orbit;
    orbit.a = std::pow(1.7, static_cast<double>(i));
    orbit.e = largest_e * unit(random);
    orbit.inclination = 0.1 * unit(random);
    orbit.node = 6 * unit(random);
    orbit.pericentre = 6 * unit(random);
    orbit.mean_anomaly = 6 * unit(random);
    const bool is_dust = with_dust && i + 1 == count;
    given.push_back({.mass = is_dust ? 0 : 1e-6 * std::pow(1000, unit(random)), .orbit = orbit});
    if (is_dust) given.back().primary = Primary::body;
    system.masses.push_back(given.back().mass);
  }
  const auto placed = states_of(given, 1.0);
  for (std::size_t i = 0; i < given.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      system.q.push_back(placed.states[i].position[k]);
      const double frame = 0.01 * (static_cast<double>(k) + 1);
      system.p.push_back((placed.states[i].velocity[k] + frame) * (given[i].mass > 0 ? given[i].mass : 1));
    }
  }
  return system;
}

Lattice fine_lattice() {
  Lattice lattice;
  lattice.position.set_unit(0x1p-54);
  lattice.momentum.set_unit(0x1p-60);
  return lattice;
}

using Step = WisdomHolmanOnLattice<P, Lattice>;

TEST(WisdomHolmanOnLattice, ReturnsEveryBit) {
  for (const double largest_e : {0.1, 0.7}) {
    for (const bool with_dust : {false, true}) {
      const System system = planets(largest_e, 8, with_dust);
      const P problem = system.problem();
      Step method(problem, describe(heliocentric));
      auto z = system.start(fine_lattice());
      const auto start = z;
      for (int k = 0; k < 2000; ++k) ASSERT_EQ(method.step(problem, 0.1, z), Outcome::done);
      EXPECT_NE(z.q, start.q);
      z.negate_momenta();
      for (int k = 0; k < 2000; ++k) ASSERT_EQ(method.step(problem, 0.1, z), Outcome::done);
      z.negate_momenta();
      EXPECT_EQ(z.q, start.q);
      EXPECT_EQ(z.p, start.p);
      EXPECT_FALSE(z.arithmetic.lost());
    }
  }
}

/// Forward with -dt undoes a step, too.
TEST(WisdomHolmanOnLattice, IsUndoneByTheStepOfOppositeLength) {
  const System system = planets(0.3);
  const P problem = system.problem();
  Step method(problem, describe(heliocentric));
  auto z = system.start(fine_lattice());
  const auto start = z;
  for (int k = 0; k < 100; ++k) ASSERT_EQ(method.step(problem, 0.1, z), Outcome::done);
  for (int k = 0; k < 100; ++k) ASSERT_EQ(method.step(problem, -0.1, z), Outcome::done);
  EXPECT_EQ(z.q, start.q);
  EXPECT_EQ(z.p, start.p);
}

TEST(WisdomHolmanOnLattice, KeepsTheTotalMomentumAsAnInteger) {
  const System system = planets(0.3);
  const P problem = system.problem();
  Step method(problem, describe(heliocentric));
  auto z = system.start(fine_lattice());
  const auto total = [&](std::size_t k) {
    std::int64_t sum = 0;
    for (std::size_t i = k; i < z.p.size(); i += 3) sum += z.p[i];
    return sum;
  };
  const std::int64_t before[] = {total(0), total(1), total(2)};
  for (int k = 0; k < 500; ++k) ASSERT_EQ(method.step(problem, 0.1, z), Outcome::done);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(total(k), before[k]);
}

/// Its error is that of one rounding of a place, and does not grow.
TEST(WisdomHolmanOnLattice, MovesTheCentreOfMassUniformly) {
  const System system = planets(0.3);
  const P problem = system.problem();
  Step method(problem, describe(heliocentric));
  auto z = system.start(fine_lattice());
  const auto centre = [&](std::size_t k) {
    long double moment = 0;
    long double mass = 0;
    for (std::size_t i = 0; i < system.masses.size(); ++i) {
      moment += system.masses[i] * static_cast<long double>(z.q[3 * i + k]);
      mass += system.masses[i];
    }
    return moment / mass * 0x1p-54L;
  };
  const long double before[] = {centre(0), centre(1), centre(2)};
  const auto momenta = z.momenta();
  for (int k = 0; k < 2000; ++k) ASSERT_EQ(method.step(problem, 0.1, z), Outcome::done);
  for (std::size_t k = 0; k < 3; ++k) {
    double p = 0;
    double mass = 0;
    for (std::size_t i = 0; i < system.masses.size(); ++i) {
      p += momenta[3 * i + k];
      mass += system.masses[i];
    }
    // V dt is rounded to the grid spacing in each of 2000 steps.
    EXPECT_NEAR(static_cast<double>(centre(k) - before[k]), 200 * p / mass, 2000 * 0x1p-55 + 1e-15);
  }
}

/// The same map in double. Each kick of a body is rounded by up to half a spacing of momentum, which moves it by up to
/// that velocity times the time that is left; there are 19 kicks in a part of each of two drifts of a step, and 8 parts
/// at most. A map with another error would miss the heavy bodies by 1e-6.
TEST(WisdomHolmanOnLattice, MovesAsInFloatingPoint) {
  for (const double largest_e : {0.05, 0.6}) {
    const System system = planets(largest_e);
    const P problem = system.problem();
    Step on_lattice(problem, describe(heliocentric));
    WisdomHolmanStep<P, Plain<double>> in_double(problem, heliocentric, describe(heliocentric));
    auto z = system.start(fine_lattice());
    auto x = system.start(Plain<double>{});
    for (int k = 0; k < 200; ++k) {
      ASSERT_EQ(on_lattice.step(problem, 0.1, z), Outcome::done);
      ASSERT_EQ(in_double.step(problem, 0.1, x), Outcome::done);
    }
    const auto q = z.positions();
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double kicks = 200 * 2 * 19 * 8;
      EXPECT_NEAR(q[i], x.q[i], kicks * 0x1p-61 / system.masses[i / 3] * 20 + 1e-11) << largest_e << " " << i;
    }
  }
}

/// Shears in double, from any place on the orbit, against the drift by universal variables.
TEST(KeplerShears, AreAKeplerDriftToRounding) {
  std::mt19937 random(46);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 200; ++k) {
    const double e = 0.9 * unit(random);
    const double t = 0.02 + unit(random);
    Vector<double, 2> r{1 - e, 0};
    Vector<double, 2> v{0, std::sqrt((1 + e) / (1 - e))};
    ASSERT_EQ(advance_on_conic(r, v, 1.0, 6.0 * unit(random)), Outcome::done);
    const auto parts = kepler_shear_parts(1, &r[0], &v[0], 2, t);
    ASSERT_TRUE(parts.has_value());
    auto end_r = cast<long double>(r);
    auto end_v = cast<long double>(v);
    ASSERT_EQ(advance_on_conic(end_r, end_v, 1.0L, static_cast<long double>(t)), Outcome::done);
    auto moved_r = cast<long double>(r);
    auto moved_v = cast<long double>(v);
    const KeplerShears& shears = kepler_shears();
    for (std::size_t part = 0; part < *parts; ++part) {
      for (std::size_t s = 0; s < shears.drifts.size(); ++s) {
        const long double time = static_cast<long double>(t) / static_cast<long double>(*parts);
        for (std::size_t i = 0; i < 2; ++i) moved_r[i] += time * shears.drifts[s] * moved_v[i];
        if (s == shears.kicks.size()) continue;
        const long double square = moved_r[0] * moved_r[0] + moved_r[1] * moved_r[1];
        for (std::size_t i = 0; i < 2; ++i) {
          moved_v[i] -= time * shears.kicks[s] * moved_r[i] / (square * std::sqrt(square));
        }
      }
    }
    // The drift about the pericentre has the largest error, 2^-53 of the largest component. The table's entries are
    // rounded to double, which changes a part by up to 2^-53 of its way.
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(static_cast<double>(moved_r[i] - end_r[i]), 0, 8e-16 * (1 + e)) << e << " " << t;
      EXPECT_NEAR(static_cast<double>(moved_v[i] - end_v[i]), 0, 8e-16 * std::sqrt((1 + e) / (1 - e))) << e << " " << t;
    }
  }
}

TEST(KeplerShears, RefuseAnOrbitThroughTheCentre) {
  const double r[] = {1, 0};
  const double radial[] = {0.3, 0};
  EXPECT_FALSE(kepler_shear_parts(1, r, radial, 2, 0.1).has_value());
  const double narrow[] = {0, 1e-4};
  EXPECT_FALSE(kepler_shear_parts(1, r, narrow, 2, 0.1).has_value());
}

}  // namespace
}  // namespace hamflow
