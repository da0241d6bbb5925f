// Constraints: multipliers, generalised coordinates by differentiation, and long runs of rattle.
#include <gtest/gtest.h>

#include "../support/bound_mass.hpp"
#include "core/constrained_motion.hpp"
#include "hamflow/methods/rattle.hpp"
#include "hamflow/methods/taylor.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "problems/generalised.hpp"

namespace hamflow {
namespace {

using test::OnCircle;
using test::OnRods;
using test::OnSphere;
using test::RodAngles;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A state on the rods from angles and their momenta.
Start<double, 4> on_rods(const Vector<double, 2>& q, const Vector<double, 2>& p) {
  return Generalised(OnRods<double>(), RodAngles()).to_cartesian(Start<double, 2>{q, p});
}

DoublePendulumNonlinearAbsolute<double> in_angles() {
  return DoublePendulumNonlinearAbsolute<double>({1, 2}, {1, 0.75}, {0, 0}, 5);
}

TEST(Constraints, GradientsByDualNumbers) {
  const Vector<double, 4> q{0.3, -0.7, 0.2, -1.1};
  const auto rows = constraint_gradients(OnRods<double>(), q);
  ASSERT_EQ(rows.size(), 2u);
  const double x = q[2] - 2 * q[0];
  const double y = q[3] - 2 * q[1];
  const Vector<double, 4> first{2 * q[0], 2 * q[1], 0, 0};
  const Vector<double, 4> second{-4 * x, -4 * y, 2 * x, 2 * y};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(rows[0][i], first[i], 4 * epsilon);
    EXPECT_NEAR(rows[1][i], second[i], 16 * epsilon);
  }
}

TEST(Constraints, MultipliersKeepTheSecondDerivativeOfGAtZero) {
  // g along the field, by central differences of g' v: 0 to their truncation h^2 and rounding epsilon/h.
  const OnRods<double> problem;
  const ConstrainedField field(problem);
  const auto start = on_rods({0.4, -0.9}, {0.5, 0.3});
  Vector<double, 4> dq{};
  Vector<double, 4> dp{};
  field.gradient(start.q, start.p, dq, dp);
  const auto rates = [&](double h) {
    Vector<double, 4> q = start.q;
    Vector<double, 4> p = start.p;
    for (std::size_t i = 0; i < 4; ++i) {
      q[i] += h * dp[i];
      p[i] -= h * dq[i];
    }
    return products(constraint_gradients(problem, q), inverse_mass_times(problem, p));
  };
  const double h = 1e-5;
  const auto ahead = rates(h);
  const auto behind = rates(-h);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR((ahead[k] - behind[k]) / (2 * h), 0, 1e-8);
}

TEST(Constraints, GeneralisedCoordinatesByDifferentiation) {
  // H(Q, P) of the map alone is that of the double pendulum by hand, and so are the gradients.
  const Generalised found{OnRods<double>(), RodAngles()};
  const auto by_hand = in_angles();
  for (int k = 0; k < 10; ++k) {
    const Vector<double, 2> q{0.7 * k, 0.3 - 0.9 * k};
    const Vector<double, 2> p{0.4 - 0.2 * k, 0.1 * k};
    const double size = 100;  // of the terms of H and its derivatives
    EXPECT_NEAR(energy(found, q, p), energy(by_hand, q, p), 16 * epsilon * size);
    Vector<double, 2> dq{}, dp{}, hand_q{}, hand_p{};
    gradient(found, q, p, dq, dp);
    gradient(by_hand, q, p, hand_q, hand_p);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(dq[i], hand_q[i], 64 * epsilon * size);
      EXPECT_NEAR(dp[i], hand_p[i], 64 * epsilon * size);
    }
    // There and back; energy in Cartesian coordinates; on the constraints and along them.
    const auto there = found.to_cartesian(Start<double, 2>{q, p});
    const auto back = found.momenta(q, there.p);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(back[i], p[i], 64 * epsilon);
    const OnRods<double> problem;
    EXPECT_NEAR(energy(problem, there.q, there.p), energy(by_hand, q, p), 16 * epsilon * size);
    const auto rates = products(constraint_gradients(problem, there.q), inverse_mass_times(problem, there.p));
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(constraints(problem, there.q)[i], 0, 16 * epsilon);
      EXPECT_NEAR(rates[i], 0, 64 * epsilon);
    }
  }
}

TEST(Constraints, OntoTheManifold) {
  const OnRods<double> problem;
  Vector<double, 4> q{0.5, -0.9, 0.6, -2.3};
  Vector<double, 4> p{0.3, 0.4, -0.1, 0.8};
  move_onto_constraints(problem, q, p);
  const auto rates = products(constraint_gradients(problem, q), inverse_mass_times(problem, p));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(constraints(problem, q)[i], 0, 16 * epsilon);
    EXPECT_NEAR(rates[i], 0, 16 * epsilon);
  }
}

/// Errors after time 1 against the same motion in angles.
template <class Recipe, class P>
double error_on_rods(const P& problem, const Recipe& recipe, int steps) {
  const Vector<double, 2> q{0.4, -0.9};
  const Vector<double, 2> p{0.5, 0.3};
  const auto start = on_rods(q, p);
  auto run = simulate<false>(problem, recipe, start.q, start.p, 1.0 / steps);
  auto exact = simulate<false>(in_angles(), Taylor{{.tolerance = 1e-15}}, q, p, 1.0 / 16);
  EXPECT_EQ(run.advance(steps), Outcome::done);
  EXPECT_EQ(exact.advance(16), Outcome::done);
  const auto end = on_rods(exact.state().positions(), exact.state().momenta());
  double most = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    most = std::max(
        {most, std::abs(run.state().positions()[i] - end.q[i]), std::abs(run.state().momenta()[i] - end.p[i])});
  }
  return most;
}

TEST(Constraints, ThreeFormsAgreeAtTheOrderOfEach) {
  const OnRods<double> problem;
  const auto slope = [](double coarse, double fine) { return std::log2(coarse / fine); };
  for (const int order : {2, 4}) {
    const Rattle method{{.order = order}};
    const double coarse = error_on_rods(problem, method, 160);
    const double fine = error_on_rods(problem, method, 320);
    EXPECT_NEAR(slope(coarse, fine), order, 0.15);
    EXPECT_LT(fine, 1e-3);
  }
  // The field with multipliers by a Taylor series: to the rounding that 16 steps and the conversion leave.
  EXPECT_LT(error_on_rods(ConstrainedField(problem), Taylor{{.tolerance = 1e-15}}, 16), 1e-12);
  // Angles by differentiation of the map.
  const Generalised found(problem, RodAngles());
  auto by_map = simulate<false>(found, Taylor{{.tolerance = 1e-15}}, Vector<double, 2>{0.4, -0.9},
                                Vector<double, 2>{0.5, 0.3}, 1.0 / 16);
  auto by_hand = simulate<false>(in_angles(), Taylor{{.tolerance = 1e-15}}, Vector<double, 2>{0.4, -0.9},
                                 Vector<double, 2>{0.5, 0.3}, 1.0 / 16);
  EXPECT_EQ(by_map.advance(16), Outcome::done);
  EXPECT_EQ(by_hand.advance(16), Outcome::done);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(by_map.state().positions()[i], by_hand.state().positions()[i], 1e-12);
  }
}

template <class P, std::size_t n>
void expect_to_stay(const P& problem, Vector<double, n> q, Vector<double, n> p, int order, double h, double level) {
  move_onto_constraints(problem, q, p);
  auto run = simulate<false>(problem, Rattle{{.order = order}}, q, p, h);
  const double before = energy(problem, q, p);
  double position = 0;
  double velocity = 0;
  double worst = 0;
  for (int block = 0; block < 2000; ++block) {
    ASSERT_EQ(run.advance(10), Outcome::done);
    const auto now_q = run.state().positions();
    const auto now_p = run.state().momenta();
    for (const double g : constraints(problem, now_q)) position = std::max(position, std::abs(g));
    for (const double g : products(constraint_gradients(problem, now_q), inverse_mass_times(problem, now_p))) {
      velocity = std::max(velocity, std::abs(g));
    }
    worst = std::max(worst, std::abs(energy(problem, now_q, now_p) - before));
  }
  // g has terms of the size 5 and rounds a handful of times, whatever the number of steps.
  EXPECT_LE(position, 16 * epsilon);
  EXPECT_LE(velocity, 64 * epsilon);
  EXPECT_LE(worst, level);
}

TEST(Constraints, RattleStaysOnTheManifold) {
  expect_to_stay(OnCircle<double>(), Vector<double, 2>{0.8, -0.6}, Vector<double, 2>{0.3, 0.4}, 2, 0.05, 1e-3);
  expect_to_stay(OnSphere<double, 3>(), Vector<double, 3>{0.8, 0, -0.6}, Vector<double, 3>{0.1, 0.7, 0.1}, 4, 0.05,
                 1e-5);
  expect_to_stay(OnRods<double>(), Vector<double, 4>{0.4, -0.9, 0.5, -2.5}, Vector<double, 4>{0.3, 0.1, 0.5, 0.1}, 2,
                 0.005, 1e-2);
}

TEST(Constraints, RattleReturns) {
  const OnRods<double> problem;
  const auto start = on_rods({0.4, -0.9}, {0.5, 0.3});
  auto run = simulate<false>(problem, Rattle{}, start.q, start.p, 0.01);
  ASSERT_EQ(run.advance(200), Outcome::done);
  run.negate_momenta();
  ASSERT_EQ(run.advance(200), Outcome::done);
  run.negate_momenta();
  // 400 steps of a handful of roundings each, which the motion carries back some ten times larger.
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(run.state().positions()[i], start.q[i], 1e-12);
    EXPECT_NEAR(run.state().momenta()[i], start.p[i], 1e-11);
  }
}

TEST(Constraints, RotationAboutTheVerticalIsKept) {
  Vector<double, 3> q{0.8, 0.1, -0.6};
  Vector<double, 3> p{-0.2, 0.7, 0.3};
  const OnSphere<double, 3> problem;
  move_onto_constraints(problem, q, p);
  auto run = simulate<false>(problem, Rattle{}, q, p, 0.05);
  const double before = q[0] * p[1] - q[1] * p[0];
  ASSERT_EQ(run.advance(10'000), Outcome::done);
  const auto x = run.state().positions();
  const auto y = run.state().momenta();
  EXPECT_NEAR(x[0] * y[1] - x[1] * y[0], before, 16 * epsilon * std::sqrt(10'000));
}

TEST(Constraints, CapabilityIsFound) {
  EXPECT_TRUE(includes(capabilities_of<OnRods<double>>(), Capability::constrained));
  EXPECT_FALSE(includes(capabilities_of<DoublePendulumNonlinearAbsolute<double>>(), Capability::constrained));
  EXPECT_FALSE(Rattle::accepts<DoublePendulumNonlinearAbsolute<double>>);
}

}  // namespace
}  // namespace hamflow
