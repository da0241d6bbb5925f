// One step equation, several ways to solve it: with p eliminated, with a cyclic coordinate closed, in (q, p), for fixed
// and for any number of coordinates, with derivatives by hand and by dual numbers.
#include "../support/near.hpp"
#include "hamflow/detail/problems/two_bodies.hpp"
#include "hamflow/methods/boris.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/problems/magnetic.hpp"
#include "hamflow/problems/of_any_size/n_body.hpp"
#include "hamflow/problems/potentials/binomial.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/problems/support/from_functions.hpp"
#include "hamflow/problems/support/polar.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace hamflow {
namespace {

using Polar = PolarCentralForce<double, Kepler>;
using Plane = CentralForce<double, Kepler>;

/// cg with a solver of our choice.
template <class Element>
struct CgBy {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  template <class P>
  static constexpr bool accepts = Smooth<P>;
  CgOptions options{.quadrature = 5};
  template <class P, class A>
  using Stepper = ContinuousGalerkin<P, A, Element>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, options);
  }
};

/// The largest difference of two simulations that ran equally far.
template <class A, class B>
double difference(const A& a, const B& b) {
  Frame left;
  Frame right;
  a.look(left);
  b.look(right);
  double largest = 0;
  for (std::size_t i = 0; i < left.q.size(); ++i) {
    largest = std::max({largest, std::fabs(left.q[i] - right.q[i]), std::fabs(left.p[i] - right.p[i])});
  }
  return largest;
}

/// Two solvers of one equation stay together up to what rounding does to a regular orbit: a few epsilon a step, growing
/// linearly with the phase.
template <class A, class B>
void expect_same_steps(A& a, B& b, int steps) {
  ASSERT_EQ(a.advance(1), Outcome::done);
  ASSERT_EQ(b.advance(1), Outcome::done);
  EXPECT_LE(difference(a, b), 8 * test::epsilon);
  ASSERT_EQ(a.advance(steps - 1), Outcome::done);
  ASSERT_EQ(b.advance(steps - 1), Outcome::done);
  EXPECT_LE(difference(a, b), 8.0 * steps * steps * test::epsilon / 16);
  EXPECT_LE(a.energy().max_error, 64 * test::epsilon);
  EXPECT_LE(b.energy().max_error, 64 * test::epsilon);
}

TEST(Elements, NewtonInPositionsAloneSolvesWhatNewtonInBothSolves) {
  const HenonHeiles<double> problem;
  auto natural = simulate(problem, Cg{{.quadrature = 3}}, {0.3, -0.15}, {0.2, 0.25}, 0.2);
  auto general = simulate(problem, CgBy<GeneralElement<HenonHeiles<double>, double>>{{.quadrature = 3}}, {0.3, -0.15},
                          {0.2, 0.25}, 0.2);
  expect_same_steps(natural, general, 200);
}

TEST(Elements, AClosedAngleSolvesWhatNewtonInAllCoordinatesSolves) {
  const Polar problem(1.0, Kepler<double>(1.0));
  auto closed = simulate(problem, Cg{{.quadrature = 6}}, {1.0, 0.0}, {0.0, 1.1}, 0.1);
  auto general = simulate(problem, CgBy<GeneralElement<Polar, double>>{{.quadrature = 6}}, {1.0, 0.0}, {0.0, 1.1}, 0.1);
  expect_same_steps(closed, general, 200);
  EXPECT_EQ(closed.state().p[1].high, 1.1) << "p_phi is constant by construction, to the last bit";
  EXPECT_GT(closed.state().q[1].high, 6.0) << "phi is not wrapped";
}

TEST(Elements, AnyNumberOfCoordinatesIsSolvedLikeAFixedOne) {
  const NBody<double> problem(
      Parameters<double>({{"masses", "[1, 0.5]"}, {"gravitational_constant", "1"}, {"softening", "0"}}), 4);
  auto natural = simulate(problem, Cg{{.quadrature = 6}}, {0, 0, 1, 0}, {0, -0.5, 0, 0.5}, 0.05);
  auto general = simulate(problem, CgBy<GeneralElement<NBody<double>, double>>{{.quadrature = 6}}, {0, 0, 1, 0},
                          {0, -0.5, 0, 0.5}, 0.05);
  expect_same_steps(natural, general, 200);
}

TEST(Elements, DerivativesByDualNumbersSolveTheSameEquation) {
  const DoublePendulumNonlinearAbsolute<double> by_hand;
  const auto by_dual_numbers = hamiltonian<2>([](const auto& q, const auto& p) {
    // Unit masses and rods: M = [[5, 2 c], [2 c, 1]].
    const auto c = cos(q[0] - q[1]);
    return (p[0] * p[0] - 4.0 * c * p[0] * p[1] + 5.0 * p[1] * p[1]) / (2.0 * (5.0 - 4.0 * c * c)) -
           9.81 * (3.0 * cos(q[0]) + cos(q[1]));
  });
  const Vector<double, 2> q{0.7, -0.5};
  const Vector<double, 2> p{1.5, 0.6};
  auto a = simulate(by_hand, Cg{{.quadrature = 5}}, q, p, 0.01);
  auto b = simulate(by_dual_numbers, Cg{{.quadrature = 5}}, q, p, 0.01);
  for (auto* each : {static_cast<Simulation*>(&a), static_cast<Simulation*>(&b)}) {
    ASSERT_EQ(each->advance(1), Outcome::done);
  }
  EXPECT_LE(difference(a, b), 64 * test::epsilon);  // H is of size 40
  ASSERT_EQ(a.advance(99), Outcome::done);
  ASSERT_EQ(b.advance(99), Outcome::done);
  EXPECT_LE(difference(a, b), 1e4 * 40 * test::epsilon);
  EXPECT_EQ(a.effort().gradient, b.effort().gradient);
}

TEST(Elements, AWrongTangentWouldShowInTheIterations) {
  // Newton with the exact tangent needs two corrections where the step is a twentieth of a period, three where it is a
  // fifth; without the mixed derivatives it converges linearly.
  const Polar problem(1.0, Kepler<double>(1.0));
  auto general = simulate(problem, CgBy<GeneralElement<Polar, double>>{}, {1.0, 0.0}, {0.2, 1.1}, 0.3);
  ASSERT_EQ(general.advance(100), Outcome::done);
  EXPECT_LE(general.effort().solves_max, 4);
}

TEST(Polar, AgreesWithCartesianCoordinatesAsTheStepShrinks) {
  // Different discretisations of one motion: both of order 2, so that their difference falls by 4 when h is halved.
  const Start<double, 2> start{{1.0, 0.0}, {0.1, 1.2}};
  const Start<double, 2> polar = to_polar(start);
  double last = 0;
  for (const double h : {0.02, 0.01, 0.005}) {
    auto plane = simulate(Plane(1.0, Kepler<double>(1.0)), Cg{{.quadrature = 6}}, start.q, start.p, h);
    auto angles = simulate(Polar(1.0, Kepler<double>(1.0)), Cg{{.quadrature = 6}}, polar.q, polar.p, h);
    const auto steps = static_cast<std::int64_t>(std::lround(5 / h));
    ASSERT_EQ(plane.advance(steps), Outcome::done);
    ASSERT_EQ(angles.advance(steps), Outcome::done);
    Frame frame;
    angles.look(frame);
    const auto back = to_cartesian(Start<double, 2>{{frame.q[0], frame.q[1]}, {frame.p[0], frame.p[1]}});
    plane.look(frame);
    const double apart = std::hypot(back.q[0] - frame.q[0], back.q[1] - frame.q[1]);
    if (last > 0) {
      EXPECT_NEAR(last / apart, 4, 0.1);
    }
    last = apart;
  }
  EXPECT_LT(last, 1e-4);
}

TEST(Polar, GoesThroughTheCentreWithoutAngularMomentum) {
  const PolarCentralForce<double, Binomial> problem(2.0, Binomial<double>(1.0, 7.0));
  auto line = simulate(problem, Cg{{.quadrature = 5}}, {4.0, 0.5}, {0.0, 0.0}, 0.1);
  ASSERT_EQ(line.advance(10), Outcome::done);
  EXPECT_LT(line.state().q[0].high, 0);
  EXPECT_EQ(line.state().q[1].high, 0.5);
  EXPECT_LE(line.energy().max_error, 64 * 40.5 * test::epsilon);
}

TEST(TwoBodies, TheReducedMotionIsThatOfTheFullOne) {
  const Body first{2.0, {0.3, -0.2, 0.5}, {0.1, 0.2, -0.1}};
  const Body second{0.5, {1.2, 0.4, 0.1}, {-0.3, 1.1, 0.6}};
  const TwoBodies reduced(first, second);
  // G m1 m2 = k, mu = m1 m2/(m1 + m2).
  const double constant = 1.7;
  const Plane plane(reduced.reduced_mass(), Kepler<double>(constant * first.mass * second.mass));
  const NBody<double> full(
      Parameters<double>({{"masses", "[2, 0.5]"}, {"gravitational_constant", "1.7"}, {"softening", "0"}}), 6);
  Vector<double, dynamic> q(6);
  Vector<double, dynamic> p(6);
  for (std::size_t k = 0; k < 3; ++k) {
    q[k] = first.position[k];
    q[3 + k] = second.position[k];
    p[k] = first.mass * first.velocity[k];
    p[3 + k] = second.mass * second.velocity[k];
  }
  const auto step = Composition<compositions::stv4>{};
  auto in_plane = simulate(plane, step, reduced.start().q, reduced.start().p, 0.01);
  auto in_space = simulate(full, step, q, p, 0.01);
  ASSERT_EQ(in_plane.advance(1000), Outcome::done);
  ASSERT_EQ(in_space.advance(1000), Outcome::done);
  const auto [one, other] =
      reduced.at(10.0, {in_plane.state().q[0], in_plane.state().q[1]}, {in_plane.state().p[0], in_plane.state().p[1]});
  for (std::size_t k = 0; k < 3; ++k) {
    // The map of a step commutes with the reduction: only rounding separates the two, growing linearly with the phase.
    EXPECT_NEAR(one.position[k], in_space.state().q[k], 1e6 * test::epsilon);
    EXPECT_NEAR(other.position[k], in_space.state().q[3 + k], 1e6 * test::epsilon);
    EXPECT_NEAR(one.velocity[k] * 2.0, in_space.state().p[k], 1e6 * test::epsilon);
  }
  const auto invariants = in_space.invariants();
  ASSERT_EQ(invariants.size(), 3u);
  for (const InvariantExcursion& each : invariants) {
    EXPECT_EQ(each.initial.size(), 3u);
    EXPECT_LE(each.max_error, 1e4 * test::epsilon);
  }
}

TEST(TwoBodies, MotionOnALineAndAtRestHaveAPlaneToo) {
  const TwoBodies rest({1, {0, 0, 0}, {0, 0, 0}}, {1, {0, 0, 2}, {0, 0, 0}});
  EXPECT_EQ(rest.start().q[0], 2);
  EXPECT_EQ(rest.start().p, (Vector<double, 2>{0, 0}));
  const TwoBodies line({1, {0, 0, 0}, {0, 0, 0}}, {1, {1, 1, 1}, {-1, -1, -1}});
  EXPECT_NEAR(line.start().p[1], 0, 4 * test::epsilon);
  const auto [a, b] = line.at(0, line.start().q, line.start().p);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(b.position[k], 1, 4 * test::epsilon);
    EXPECT_NEAR(a.velocity[k], 0, 4 * test::epsilon);
  }
}

TEST(Boris, FollowsTheHelixAtOrderTwoAndKeepsTheSpeed) {
  const Magnetic<double> problem(2.0, {0.3, -0.4, 1.2});
  const Vector<double, 3> q{0.4, -0.3, 0.2};
  const Vector<double, 3> p{0.5, 0.3, 0.4};
  const auto exact = problem.exact(cast<long double>(q), cast<long double>(p), 10.0L);
  ASSERT_TRUE(exact);
  double last = 0;
  for (const int steps : {50, 100, 200}) {
    auto run = simulate(problem, Boris{}, q, p, 10.0 / steps);
    ASSERT_EQ(run.advance(steps), Outcome::done);
    EXPECT_LE(run.energy().max_error, 32 * test::epsilon);
    double apart = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      apart = std::max(apart, std::fabs(run.state().q[k].high - static_cast<double>(exact->q[k])));
    }
    if (last > 0) {
      EXPECT_NEAR(last / apart, 4, 0.1);
    }
    last = apart;
  }
}

TEST(Magnetic, ReversingTheMomentaDoesNotReverseTheMotion) {
  const Magnetic<double> problem(1.0, {0.0, 0.0, 1.0});
  auto run = simulate(problem, Boris{}, {1, 0, 0}, {0, 1, 0.5}, 0.01);
  ASSERT_EQ(run.advance(100), Outcome::done);
  run.negate_momenta();
  ASSERT_EQ(run.advance(100), Outcome::done);
  EXPECT_GT(std::hypot(run.state().q[0].high - 1, run.state().q[1].high), 0.1);
}

}  // namespace
}  // namespace hamflow
