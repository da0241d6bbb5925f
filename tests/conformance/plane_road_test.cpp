// The straight road of cg(1) in the plane has the bits, and the counters, of Newton's iteration, which a run with
// diagnostics takes.
#include <gtest/gtest.h>

#include "hamflow/methods/cg.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace hamflow {
namespace {

using PlaneKepler = CentralForce<double, Kepler>;

void expect_bits_of_newton(const CgOptions& options, const PlaneKepler& problem, const Vector<double, 2>& p, double h) {
  CgOptions watched = options;
  watched.diagnostics = true;
  auto straight = simulate(problem, Cg{options}, {1, 0}, p, h);
  auto by_newton = simulate(problem, Cg{watched}, {1, 0}, p, h);
  for (int block = 0; block < 12; ++block) {
    ASSERT_EQ(straight.advance(50), by_newton.advance(50));
    ASSERT_EQ(straight.bits(), by_newton.bits()) << options.quadrature << " points, h = " << h;
    if (block == 6) {
      straight.reverse_time();
      by_newton.reverse_time();
    }
  }
  EXPECT_EQ(straight.effort().force, by_newton.effort().force);
  EXPECT_EQ(straight.effort().hessian, by_newton.effort().hessian);
  EXPECT_EQ(straight.effort().linear_solves, by_newton.effort().linear_solves);
  EXPECT_EQ(straight.effort().solves_max, by_newton.effort().solves_max);
  EXPECT_EQ(straight.energy().max_error, by_newton.energy().max_error);
}

TEST(PlaneRoad, HasTheBitsOfNewton) {
  static_assert(TakesTwo<PlaneKepler>);
  for (const double h : {0.3, 0.1, 0.01, -0.1, 2.0}) {
    for (const int points : {1, 2, 3, 4, 5, 8, 33, 64}) {
      for (const double k : {1.0, 0.3, -1.0}) {
        const PlaneKepler problem(2.0, Kepler<double>(k));
        expect_bits_of_newton({.quadrature = points}, problem, {0, 1.7}, h);
        expect_bits_of_newton({.quadrature = points, .max_iterations = 2, .halve = true}, problem, {0.1, 0.9}, h);
      }
    }
  }
}

}  // namespace
}  // namespace hamflow
