// Poincare sections on partial steps: where the points lie, how many there are, and when.
#include "hamflow/run/section.hpp"

#include "../support/near.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/problems/harmonic.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace hamflow {
namespace {

using test::epsilon;
using test::within;
using Stv4 = Composition<compositions::stv4>;

struct Found {
  std::vector<SectionPoint> points;
  double max_residual = 0;
  double max_energy_error = 0;
};

/// A run with a section, and that the run goes as it does without.
Found sections(Simulation& simulation, const Section& section, std::int64_t steps) {
  const auto alone = simulation.clone();
  Found found;
  SectionFinder finder(simulation, section, [&](const SectionPoint& point) { found.points.push_back(point); });
  Observer* const observers[] = {&finder};
  EXPECT_EQ(run(simulation, steps, observers), Outcome::done);
  EXPECT_EQ(alone->advance(steps), Outcome::done);
  EXPECT_EQ(simulation.bits(), alone->bits());
  EXPECT_FALSE(finder.failed());
  EXPECT_EQ(finder.points(), static_cast<std::int64_t>(found.points.size()));
  found.max_residual = finder.max_residual();
  found.max_energy_error = simulation.energy().max_error;
  return found;
}

auto chaotic_henon_heiles(double h, double t0 = 0) {
  const double p1 = std::sqrt(2 * (1.0 / 6 - 0.15 * 0.15 / 2 - 0.15 * 0.15 * 0.15 / 3) - 0.01);
  using P = HenonHeiles<double>;
  const P problem;
  auto method = Stv4{}.bind<P, Plain<double>>(problem);
  return SimulationOf<P, decltype(method), Plain<double>>(problem, method, {0, -0.15}, {p1, 0.1}, h, {}, t0);
}

TEST(Section, PointsLieOnItToRoundingAndOnTheEnergyLevel) {
  const HenonHeiles<double> problem;
  for (const double t0 : {0.0, 1e9}) {  // late, too: the time within a step does not suffer from the time before it
    for (const double value : {0.0, 0.125}) {
      auto simulation = chaotic_henon_heiles(0.1, t0);
      const double energy = simulation.energy().initial;
      const Found found = sections(simulation, {.coordinate = 0, .value = value}, 20000);
      ASSERT_GT(found.points.size(), 200U);
      // theta is known to rounding, x moves by less than 0.1 in a step, and is of size 1.
      EXPECT_LE(found.max_residual, 2 * epsilon);
      for (const SectionPoint& point : found.points) {
        EXPECT_LE(std::abs(point.q[0] - value), found.max_residual);
        EXPECT_GT(point.p[0], 0);
        const double h = hamflow::energy(problem, Vector<double, 2>{point.q[0], point.q[1]},
                                         Vector<double, 2>{point.p[0], point.p[1]});
        EXPECT_LE(std::abs(h - energy), 2 * found.max_energy_error);
      }
    }
  }
}

TEST(Section, SameNumberAsWithSmallSteps) {
  // Chaos makes e^8 of a difference in this time; the error of a step is some h^5.
  auto coarse = chaotic_henon_heiles(0.02);
  auto fine = chaotic_henon_heiles(0.02 / 16);
  const Section both{.coordinate = 1, .momentum = true, .value = 0.05, .direction = 0};
  const Found few = sections(coarse, both, 3000);
  const Found many = sections(fine, both, 3000 * 16);
  ASSERT_GT(few.points.size(), 10U);
  ASSERT_EQ(few.points.size(), many.points.size());
  for (std::size_t k = 0; k < few.points.size(); ++k) EXPECT_NEAR(few.points[k].time, many.points[k].time, 1e-3);
}

TEST(Section, DirectionsAddUp) {
  std::vector<std::size_t> count;
  for (const int direction : {-1, 0, 1}) {
    auto simulation = chaotic_henon_heiles(0.1);
    const Found found = sections(simulation, {.coordinate = 1, .value = 0.1, .direction = direction}, 5000);
    count.push_back(found.points.size());
    for (const SectionPoint& point : found.points) {
      EXPECT_GE(point.p[1] * direction, 0);
    }
  }
  EXPECT_EQ(count[1], count[0] + count[2]);
  EXPECT_LE(std::max(count[0], count[2]) - std::min(count[0], count[2]), 1U);  // they alternate
}

TEST(Section, StartAndExactHitsCountOnce) {
  // Free of forces, q = t/8: steps hit 0 and 1 exactly.
  auto simulation = simulate(Harmonic<double>(1.0, 0.0), Stv4{}, {0}, {0.125}, 1.0);
  const Found none = sections(simulation, {.coordinate = 0, .value = 0, .direction = 0}, 20);
  EXPECT_EQ(none.points.size(), 0U);
  auto again = simulate(Harmonic<double>(1.0, 0.0), Stv4{}, {0}, {0.125}, 1.0);
  const Found one = sections(again, {.coordinate = 0, .value = 1, .direction = 0}, 20);
  ASSERT_EQ(one.points.size(), 1U);
  EXPECT_TRUE(within(one.points[0].time, 8, 8 * epsilon));
  EXPECT_LE(one.max_residual, epsilon);
}

/// Upward crossings of y = 0 on a Kepler ellipse, a = 1: one in each period of 2 pi.
template <class Recipe>
double worst_period(const Recipe& recipe, double h, double& residual) {
  using P = CentralForce<double, Kepler>;
  auto simulation = simulate(P(1, Kepler<double>(1)), recipe, {0.5, 0}, {0, std::sqrt(3.0)}, h);
  const double period = 2 * std::acos(-1.0);
  const Found found = sections(simulation, {.coordinate = 1}, static_cast<std::int64_t>(20.5 * period / h));
  EXPECT_EQ(found.points.size(), 20U);
  residual = found.max_residual;
  double worst = 0;
  for (std::size_t k = 1; k < found.points.size(); ++k) {
    worst = std::max(worst, std::abs(found.points[k].time - found.points[k - 1].time - period));
  }
  return worst;
}

TEST(Section, KeplerPeriodsConvergeWithTheOrderOfTheMethod) {
  double residual = 0;
  const double coarse = worst_period(Stv4{}, 0.01, residual);
  EXPECT_LE(residual, epsilon);
  const double fine = worst_period(Stv4{}, 0.0025, residual);
  EXPECT_LE(residual, epsilon);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_GT(coarse / fine, 100);  // order 4: 256
  EXPECT_LT(coarse / fine, 600);
  CgOptions options;
  options.degree = 1;
  options.quadrature = 6;
  (void)worst_period(Cg{options}, 0.02, residual);
  EXPECT_LE(residual, 2 * epsilon);  // an implicit step is as continuous in its length as its solver is exact
}

}  // namespace
}  // namespace hamflow
