// The evaluations that a method reports are those that the problem sees.
#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/methods/averages.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/methods/compositions/kahan_li8.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/force_gradient.hpp"
#include "hamflow/methods/force_gradient/chin4a.hpp"
#include "hamflow/methods/force_gradient/chin4b.hpp"
#include "hamflow/methods/runge_kutta.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/splittings/euler_a.hpp"
#include "hamflow/methods/splittings/mcate4.hpp"
#include "hamflow/methods/splittings/pefrl.hpp"
#include "hamflow/methods/splittings/srkn6b.hpp"
#include "hamflow/methods/tableaus/rk4.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace hamflow {
namespace {

/// Henon-Heiles that counts.
struct Counting {
  using Real = double;
  static constexpr std::size_t dimension = 2;
  static constexpr bool quadratic_kinetic = true;
  HenonHeiles<double> problem{};
  long long* forces;
  long long* hessians;

  template <class S>
  S kinetic(const Vector<S, 2>& p) const {
    return problem.kinetic(p);
  }
  template <class S>
  S potential(const Vector<S, 2>& q) const {
    return problem.potential(q);
  }
  template <class S>
  void velocity(const Vector<S, 2>& p, Vector<S, 2>& v) const {
    problem.velocity(p, v);
  }
  template <class S>
  void force(const Vector<S, 2>& q, Vector<S, 2>& f) const {
    ++*forces;
    problem.force(q, f);
  }
  template <class S>
  void potential_hessian(const Vector<S, 2>& q, Matrix<S, 2>& out) const {
    ++*hessians;
    problem.potential_hessian(q, out);
  }
};

/// First order: what matters is that the two kicks between two drifts differ in strength.
constexpr SplittingTable unlike_ends{.name = "unlike-ends",
                                     .order = 1,
                                     .reference = "",
                                     .starts_with = StartsWith::kick,
                                     .coefficients = {"1/4", "1", "3/4"}};

template <class Recipe>
void expect_counts(const Recipe& recipe, long long forces_per_step, long long at_first) {
  long long forces = 0;
  long long hessians = 0;
  const Counting problem{.forces = &forces, .hessians = &hessians};
  auto simulation = simulate<false>(problem, recipe, {0.3, -0.15}, {0.2, 0.25}, 0.1);
  for (const std::int64_t steps : {1, 9, 100}) {
    const long long before = forces;
    const long long extra = simulation.step() == 0 ? at_first : 0;
    ASSERT_EQ(simulation.advance(steps), Outcome::done);
    EXPECT_EQ(forces, simulation.effort().force);
    EXPECT_EQ(hessians, simulation.effort().hessian);
    if (forces_per_step > 0) {
      EXPECT_EQ(forces - before, forces_per_step * steps + extra);
    }
  }
  if (forces_per_step > 0) {
    EXPECT_EQ(simulation.method().forces_per_step, forces_per_step);
  }
}

TEST(Cost, ReportedEvaluationsAreThoseTheProblemSees) {
  expect_counts(Composition<compositions::stv4>{}, 3, 1);  // kick first: the last force serves the next step
  expect_counts(Composition<compositions::stv4, StartsWith::drift>{}, 3, 0);
  expect_counts(SplittingBy<splittings::euler_a>{}, 1, 0);
  expect_counts(SplittingBy<unlike_ends>{}, 1, 1);  // one force for two kicks also here
  expect_counts(Composition<compositions::kahan_li8>{}, 17, 1);
  expect_counts(SplittingBy<splittings::srkn6b>{}, 6, 1);
  expect_counts(SplittingBy<splittings::mcate4>{}, 4, 0);
  expect_counts(SplittingBy<splittings::pefrl>{}, 4, 0);
  expect_counts(ForceGradient{&force_gradient::chin4a}, 2, 1);
  expect_counts(ForceGradient{&force_gradient::chin4b}, 2, 0);
  expect_counts(RungeKuttaBy<tableaus::rk4>{}, 4, 0);
  expect_counts(Cg{CgOptions{.quadrature = 5}}, 0, 0);
  expect_counts(Cg{}, 0, 0);
  expect_counts(CgOfDegree{{.degree = 2}}, 0, 0);
  expect_counts(CgOfDegree{{.degree = 2, .quadrature = 4, .iteration = Iteration::simplified}}, 0, 0);
  expect_counts(Gauss{{.stages = 3, .iteration = Iteration::fixed_point}}, 0, 0);
}

TEST(Cost, ForceGradientsCostAHessianEach) {
  const HenonHeiles<double> problem{};
  for (const auto& [table, hessians] : {std::pair{&force_gradient::chin4a, 1}, {&force_gradient::chin4b, 2}}) {
    auto simulation = simulate<false>(problem, ForceGradient{table}, {0.3, -0.15}, {0.2, 0.25}, 0.1);
    ASSERT_EQ(simulation.advance(100), Outcome::done);
    EXPECT_EQ(simulation.effort().hessian, 100 * hessians);
  }
}

/// The kick with gradient written out: one step of chin4b, all in one place.   [Chin1997, algorithm B]
TEST(Cost, AForceGradientIsTheGradientOfTheSquaredForce) {
  const HenonHeiles<double> problem{};
  const double h = 0.1;
  const double t1 = (1 - std::sqrt(1.0 / 3)) / 2;
  const double t2 = std::sqrt(1.0 / 3);
  Vector<double, 2> q{0.3, -0.15}, p{0.2, 0.25};
  auto simulation = simulate<false>(problem, ForceGradient{&force_gradient::chin4b}, q, p, h);
  ASSERT_EQ(simulation.advance(1), Outcome::done);
  const auto drift = [&](double t) {
    for (std::size_t k = 0; k < 2; ++k) q[k] += t * h * p[k];
  };
  // V = (x^2 + y^2)/2 + x^2 y - y^3/3: V_x = x + 2 x y, V_y = y + x^2 - y^2; |V'|^2 by its own derivative.
  const auto kick = [&] {
    const double x = q[0], y = q[1];
    const double vx = x + 2 * x * y, vy = y + x * x - y * y;
    const double square_x = 2 * vx * (1 + 2 * y) + 2 * vy * 2 * x;
    const double square_y = 2 * vx * 2 * x + 2 * vy * (1 - 2 * y);
    const double c = (2 - std::sqrt(3.0)) / 24 * h * h;
    p[0] += h / 2 * (-vx + c * square_x);
    p[1] += h / 2 * (-vy + c * square_y);
  };
  drift(t1);
  kick();
  drift(t2);
  kick();
  drift(t1);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(simulation.state().q[k], q[k], 8 * std::numeric_limits<double>::epsilon());
    EXPECT_NEAR(simulation.state().p[k], p[k], 8 * std::numeric_limits<double>::epsilon());
  }
}

TEST(Cost, ATableWithUnlikeEndsKicksWithTheForceOfWhereItIs) {
  const HenonHeiles<double> problem{};
  auto simulation = simulate<false>(problem, SplittingBy<unlike_ends>{}, {0.3, -0.15}, {0.2, 0.25}, 0.1);
  Vector<double, 2> q{0.3, -0.15}, p{0.2, 0.25}, f{};
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(simulation.advance(1), Outcome::done);
    force(problem, q, f);
    for (std::size_t k = 0; k < 2; ++k) p[k] += 0.1 * 0.25 * f[k];
    for (std::size_t k = 0; k < 2; ++k) q[k] += 0.1 * p[k];
    force(problem, q, f);
    for (std::size_t k = 0; k < 2; ++k) p[k] += 0.1 * 0.75 * f[k];
    EXPECT_EQ(simulation.state().q, q);
    EXPECT_EQ(simulation.state().p, p);
  }
}

}  // namespace
}  // namespace hamflow
