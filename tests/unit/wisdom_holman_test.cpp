// The Wisdom-Holman map in Jacobi coordinates: its parts, its errors and their dependence on dt and on the masses of
// the planets, two-sided, its correctors and kernels.
#include "hamflow/methods/wisdom_holman.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/near.hpp"
#include "hamflow/arithmetic/quad.hpp"

namespace hamflow {
namespace {

using test::epsilon;
using Space = Vector<double, 3>;
using Spaces = PooledList<Space>;

/// The outer planets, in astronomical units and days, with their masses times `share`.
struct Planets {
  double constant = 2.95912208286e-4;
  std::vector<double> masses{1.00000597682, 0.000954786104043, 0.000285583733151, 0.0000437273164546,
                             0.0000517759138449};
  Spaces r{{0, 0, 0},
           {-3.5023653, -3.8169847, -1.5507963},
           {9.0755314, -3.0458353, -1.6483708},
           {8.3101420, -16.2901086, -7.2521278},
           {11.4707666, -25.7294829, -10.8169456}};
  Spaces v{{0, 0, 0},
           {0.00565429, -0.00412490, -0.00190589},
           {0.00168318, 0.00483525, 0.00192462},
           {0.00354178, 0.00137102, 0.00055029},
           {0.00288930, 0.00114527, 0.00039677}};

  explicit Planets(double share = 1) {
    for (std::size_t i = 1; i < masses.size(); ++i) masses[i] *= share;
  }
  JacobiSplitting<double> splitting() const { return {masses, constant}; }

  double energy(const Spaces& at, const Spaces& moving) const {
    double sum = 0;
    for (std::size_t i = 0; i < masses.size(); ++i) {
      sum += masses[i] * detail::inner_product(moving[i], moving[i]) / 2;
      for (std::size_t j = i + 1; j < masses.size(); ++j) {
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k) square += (at[i][k] - at[j][k]) * (at[i][k] - at[j][k]);
        sum -= constant * masses[i] * masses[j] / std::sqrt(square);
      }
    }
    return sum;
  }

  /// The largest relative energy error in 60000 days, corrector undone.
  double energy_error(double dt, WisdomHolmanKernel kernel, std::size_t stages) const {
    auto map = splitting();
    auto state = map.state_of(r, v);
    std::vector<double> weights = stages > 0 ? corrector_weights<double>(stages) : std::vector<double>();
    std::vector<double> inverse = weights;
    for (double& b : inverse) b = -b;
    EXPECT_EQ(map.correct(state, dt, weights), Outcome::done);
    const double start = energy(r, v);
    double worst = 0;
    for (int step = 0; step < 60000 / dt; ++step) {
      EXPECT_EQ(map.step(state, dt, kernel), Outcome::done);
      auto seen = state;
      EXPECT_EQ(map.correct(seen, dt, inverse), Outcome::done);
      worst = std::max(worst, std::abs(energy(map.inertial_of(seen.r), map.inertial_of(seen.v)) / start - 1));
    }
    return worst;
  }
};

double distance(const Spaces& a, const Spaces& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) most = std::max(most, std::abs(a[i][k] - b[i][k]));
  }
  return most;
}

TEST(WisdomHolman, JacobiCoordinatesReturn) {
  const Planets planets;
  const auto map = planets.splitting();
  EXPECT_LE(distance(map.inertial_of(map.jacobi_of(planets.r)), planets.r), 30 * 4 * epsilon);
  // The second planet from the centre of mass of Sun and first planet; the first entry is the centre of all.
  const Spaces jacobi = map.jacobi_of(planets.r);
  double moment = 0;
  double mass = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    moment += planets.masses[i] * planets.r[i][0];
    mass += planets.masses[i];
  }
  EXPECT_TRUE(test::within(jacobi[0][0], moment / mass, 1e-15));
  const double pair = planets.masses[1] * planets.r[1][0] / (planets.masses[0] + planets.masses[1]);
  EXPECT_TRUE(test::within(jacobi[2][0], planets.r[2][0] - pair, 1e-14));
}

TEST(WisdomHolman, TwoBodiesMoveExactly) {
  // Any step is exact: 40 steps of half a period, on an ellipse with e = 0.6.
  JacobiSplitting<double> map({3, 1}, 0.5);
  auto state = map.state_of({{0, 0, 0}, {0.4, 0, 0}}, {{0, 0, 0}, {0, 2 * std::sqrt(2.0), 0}});
  const auto start = state;
  const double half_period = 3.141592653589793 / std::sqrt(2.0);
  for (int k = 0; k < 40; ++k) ASSERT_EQ(map.step(state, half_period, WisdomHolmanKernel::standard), Outcome::done);
  // Rounding of the period and of each step, 126 radians on.
  EXPECT_LE(distance({state.r[1]}, {start.r[1]}), 1e-12);
}

TEST(WisdomHolman, IsTheMotionOfTheBodies) {
  // Against the classical Runge-Kutta method on the Newtonian equations in inertial coordinates, with steps so short
  // that its error is 1e-11.
  const Planets planets;
  Spaces r = planets.r;
  Spaces v = planets.v;
  const auto forces = [&](const Spaces& at) {
    Spaces a(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
      for (std::size_t j = 0; j < at.size(); ++j) {
        if (i == j) continue;
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k) square += (at[j][k] - at[i][k]) * (at[j][k] - at[i][k]);
        for (std::size_t k = 0; k < 3; ++k) {
          a[i][k] += planets.constant * planets.masses[j] * (at[j][k] - at[i][k]) / (square * std::sqrt(square));
        }
      }
    }
    return a;
  };
  const auto moved = [](const Spaces& x, double h, const Spaces& by) {
    Spaces out = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) out[i][k] += h * by[i][k];
    }
    return out;
  };
  const double h = 5;
  for (int step = 0; step < 400; ++step) {
    const Spaces v1 = v;
    const Spaces a1 = forces(r);
    const Spaces v2 = moved(v, h / 2, a1);
    const Spaces a2 = forces(moved(r, h / 2, v1));
    const Spaces v3 = moved(v, h / 2, a2);
    const Spaces a3 = forces(moved(r, h / 2, v2));
    const Spaces v4 = moved(v, h, a3);
    const Spaces a4 = forces(moved(r, h, v3));
    r = moved(moved(moved(moved(r, h / 6, v1), h / 3, v2), h / 3, v3), h / 6, v4);
    v = moved(moved(moved(moved(v, h / 6, a1), h / 3, a2), h / 3, a3), h / 6, a4);
  }
  double error[2];
  for (int k = 0; k < 2; ++k) {
    auto map = planets.splitting();
    auto state = map.state_of(planets.r, planets.v);
    const int steps = k == 0 ? 20 : 40;
    for (int step = 0; step < steps; ++step) {
      ASSERT_EQ(map.step(state, 2000.0 / steps, WisdomHolmanKernel::standard), Outcome::done);
    }
    error[k] = distance(map.inertial_of(state.r), r);
  }
  EXPECT_LT(error[1], 1e-5);
  EXPECT_GT(error[1], 1e-9);  // above the error of the reference
  EXPECT_NEAR(error[0] / error[1], 4, 0.3);
}

TEST(WisdomHolman, ErrorsAreProportionalToTheMassesOfThePlanets) {
  const auto standard = WisdomHolmanKernel::standard;
  const double all = Planets(1).energy_error(200, standard, 0);
  const double tenth = Planets(0.1).energy_error(200, standard, 0);
  // The energy of the Sun and its planets is itself proportional to the masses: the relative error to their first
  // power.
  EXPECT_NEAR(all / tenth, 10, 2);
  EXPECT_NEAR(Planets(1).energy_error(200, standard, 0) / Planets(1).energy_error(100, standard, 0), 4, 0.6);
}

TEST(WisdomHolman, CorrectorsRemoveWhatIsLinearInTheMasses) {
  const auto standard = WisdomHolmanKernel::standard;
  const double without = Planets(1).energy_error(100, standard, 0);
  const double third = Planets(1).energy_error(100, standard, 1);
  EXPECT_LT(third, without / 20);
  // Order 4 in dt until the error of second order in the masses is seen.
  EXPECT_NEAR(Planets(0.1).energy_error(200, standard, 1) / Planets(0.1).energy_error(100, standard, 1), 16, 4);
  // With many stages what is quadratic in the masses is left.
  const double all = Planets(1).energy_error(100, standard, 8);
  const double tenth = Planets(0.1).energy_error(100, standard, 8);
  EXPECT_NEAR(std::log10(all / tenth), 2, 0.3);
}

TEST(WisdomHolman, TheLazyKernelRemovesWhatIsQuadraticInThem) {
  const double standard = Planets(1).energy_error(100, WisdomHolmanKernel::standard, 8);
  const double lazy = Planets(1).energy_error(100, WisdomHolmanKernel::lazy, 8);
  EXPECT_LT(lazy, standard / 50);
}

TEST(WisdomHolman, CorrectorsAreUndone) {
  const Planets planets;
  auto map = planets.splitting();
  for (const std::size_t stages : {1U, 2U, 3U, 5U, 8U}) {
    std::vector<double> weights = corrector_weights<double>(stages);
    auto state = map.state_of(planets.r, planets.v);
    const auto start = state;
    ASSERT_EQ(map.correct(state, 100, weights), Outcome::done);
    EXPECT_GT(distance(state.r, start.r), 1e-8);
    for (double& b : weights) b = -b;
    ASSERT_EQ(map.correct(state, 100, weights), Outcome::done);
    EXPECT_LE(distance(state.r, start.r), 30 * 100 * epsilon);
  }
}

TEST(WisdomHolman, WeightsSolveTheirEquations) {
  const double bernoulli[8] = {1 / 6., -1 / 30., 1 / 42., -1 / 30., 5 / 66., -691 / 2730., 7 / 6., -3617 / 510.};
  for (const std::size_t stages : {1U, 2U, 3U, 5U, 8U}) {
    const std::vector<Quad> b = corrector_weights<Quad>(stages);
    const std::vector<double> in_double = corrector_weights<double>(stages);
    for (std::size_t j = 0; j < stages; ++j) {
      const int n = static_cast<int>(2 * j + 1);
      Quad sum(0);
      for (std::size_t k = 0; k < stages; ++k) {
        sum += b[k] * whole_power(Quad(static_cast<int>(k + 1)) * sqrt(Quad(7) / Quad(40)), n);
      }
      const double wanted = (1 - std::pow(2, -n)) * bernoulli[j] / (n + 1);  // times n!
      EXPECT_TRUE(test::within(static_cast<double>(sum) * 4, wanted, 8 * epsilon * std::abs(wanted)));
    }
    for (std::size_t k = 0; k < stages; ++k)
      EXPECT_TRUE(test::within(in_double[k], static_cast<double>(b[k]), epsilon));
  }
}

TEST(WisdomHolman, IsReversible) {
  const Planets planets;
  auto map = planets.splitting();
  auto state = map.state_of(planets.r, planets.v);
  for (int k = 0; k < 100; ++k) ASSERT_EQ(map.step(state, 150, WisdomHolmanKernel::lazy), Outcome::done);
  for (int k = 0; k < 100; ++k) ASSERT_EQ(map.step(state, -150, WisdomHolmanKernel::lazy), Outcome::done);
  EXPECT_LE(distance(map.inertial_of(state.r), planets.r), 1e-11);
}

TEST(WisdomHolman, MasslessBodiesFeelAndAreNotFelt) {
  Planets planets;
  auto alone = planets.splitting();
  auto without = alone.state_of(planets.r, planets.v);
  planets.masses.insert(planets.masses.begin() + 2, 0);
  planets.r.insert(planets.r.begin() + 2, {0, 3, 0});
  planets.v.insert(planets.v.begin() + 2, {-0.0099, 0, 0});
  auto map = planets.splitting();
  auto state = map.state_of(planets.r, planets.v);
  for (int k = 0; k < 50; ++k) {
    ASSERT_EQ(alone.step(without, 50, WisdomHolmanKernel::standard), Outcome::done);
    ASSERT_EQ(map.step(state, 50, WisdomHolmanKernel::standard), Outcome::done);
  }
  EXPECT_EQ(state.r[3], without.r[2]);
  EXPECT_EQ(state.v[5], without.v[4]);
  // It moves like a body of a mass so small that it is not felt.
  planets.masses[2] = 1e-25;
  auto light = planets.splitting();
  auto nearly = light.state_of(planets.r, planets.v);
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(light.step(nearly, 2.5, WisdomHolmanKernel::standard), Outcome::done);
  EXPECT_LE(distance({map.inertial_of(state.r)[2]}, {light.inertial_of(nearly.r)[2]}), 2e-4);
}

}  // namespace
}  // namespace hamflow
