// Gradients and Hessians written by hand against dual numbers; problems given as lambdas.
#include "../support/near.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/runge_kutta.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/tableaus/rk4.hpp"
#include "hamflow/problems/support/from_functions.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "hamflow/verify/counter_random.hpp"
#include "problem_list.hpp"  // generated: includes every problem, defines HAMFLOW_FOR_EACH_PROBLEM

namespace hamflow {
namespace {

/// The parts of a problem without its derivatives by hand.
template <class P>
struct PartsOnly {
  using Real = typename P::Real;
  static constexpr std::size_t dimension = P::dimension;
  static constexpr bool quadratic_kinetic = P::quadratic_kinetic;
  P problem;
  template <class S>
  S kinetic(const Vector<S, dimension>& p) const {
    return problem.kinetic(p);
  }
  template <class S>
  S potential(const Vector<S, dimension>& q) const {
    return problem.potential(q);
  }
};

/// Parameters different from 1, so that a forgotten one shows.
template <class R>
Parameters<R> uncommon_parameters(const ProblemInfo& info) {
  std::map<std::string, std::string> texts;
  int k = 0;
  for (const ParameterInfo& p : info.parameters) texts[p.name] = std::to_string(1.3 + 0.4 * k++);
  return Parameters<R>(texts);
}

template <template <class> class Family>
void derivatives_are_those_of_the_energy() {
  using P = Family<double>;
  using Exact = PartsOnly<Family<long double>>;
  constexpr std::size_t n = P::dimension;
  const P problem{uncommon_parameters<double>(P::info())};
  const Exact exact{Family<long double>{uncommon_parameters<long double>(P::info())}};
  SCOPED_TRACE(P::info().name);
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    Vector<double, n> q{};
    Vector<double, n> p{};
    for (std::size_t i = 0; i < n; ++i) {
      q[i] = 1.1 + 0.6 * counter_uniform(21, (2 * trial) * n + i);  // away from a singularity at 0
      p[i] = 1.5 * counter_uniform(21, (2 * trial + 1) * n + i);
    }
    const auto exact_q = cast<long double>(q);
    const auto exact_p = cast<long double>(p);
    Vector<long double, n> f{};
    Vector<long double, n> v{};
    Matrix<long double, n> hessian{};
    force(exact, exact_q, f);
    velocity(exact, exact_p, v);
    potential_hessian(exact, exact_q, hessian);

    Vector<double, n> hand_f{};
    Vector<double, n> hand_v{};
    Vector<double, n> both_f{};
    Vector<double, n> dq{};
    Vector<double, n> dp{};
    Matrix<double, n> hand_hessian{};
    Matrix<double, n> both_hessian{};
    force(problem, q, hand_f);
    velocity(problem, p, hand_v);
    potential_hessian(problem, q, hand_hessian);
    force_and_hessian(problem, q, both_f, both_hessian);
    gradient(problem, q, p, dq, dp);

    long double size = 0;  // of what a relative error eps in q makes of f and V''
    for (std::size_t i = 0; i < n; ++i) {
      size = larger(size, static_cast<long double>(std::fabs(f[i])));
      for (std::size_t j = 0; j < n; ++j) size = larger(size, static_cast<long double>(std::fabs(hessian[i][j])) * 2);
    }
    const long double bound = 64 * test::epsilon * size;
    EXPECT_TRUE(test::within(energy(problem, q, p), exact.kinetic(exact_p) + exact.potential(exact_q),
                             64 * test::epsilon * (std::fabs(exact.kinetic(exact_p)) + size)));
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_TRUE(test::within(hand_f[i], f[i], bound)) << "force " << i;
      EXPECT_TRUE(test::within(both_f[i], f[i], bound)) << "force of force_and_hessian " << i;
      EXPECT_TRUE(test::within(dq[i], -f[i], bound)) << "dH/dq " << i;
      EXPECT_TRUE(test::within(hand_v[i], v[i], 16 * test::epsilon * std::fabs(v[i]))) << "velocity " << i;
      EXPECT_EQ(dp[i], hand_v[i]) << "dH/dp " << i;
      for (std::size_t j = 0; j < n; ++j) {
        EXPECT_TRUE(test::within(hand_hessian[i][j], hessian[i][j], bound * 16)) << "Hessian " << i << ", " << j;
        EXPECT_TRUE(test::within(both_hessian[i][j], hessian[i][j], bound * 16)) << "Hessian " << i << ", " << j;
      }
    }
  }
}

TEST(Problems, DerivativesByHandAreThoseOfTheEnergy) {
#define HAMFLOW_CHECK(Family) derivatives_are_those_of_the_energy<Family>();
  HAMFLOW_FOR_EACH_PROBLEM(HAMFLOW_CHECK)
#undef HAMFLOW_CHECK
}

TEST(Problems, TheCheckNoticesAWrongSignAndAForgottenParameter) {
  const Pendulum<double> problem(1.0, 2.0, 3.0);
  PartsOnly<Pendulum<double>> parts{problem};
  Vector<double, 1> wrong{};
  Vector<double, 1> right{};
  force(parts, Vector<double, 1>{0.7}, right);
  Pendulum<double>(1.0, 1.0, 3.0).force(Vector<double, 1>{0.7}, wrong);
  EXPECT_FALSE(test::same_to_rounding(wrong[0], right[0], 64.0));
  EXPECT_FALSE(test::same_to_rounding(-right[0], right[0], 64.0));
}

TEST(Problems, LennardJonesStartHasTheEnergyOfTheThesis) {
  const LennardJonesOscillator<double> problem;
  const double h = energy(problem, Vector<double, 1>{1.5}, Vector<double, 1>{0});
  EXPECT_TRUE(test::within(h, -0.1678756438, 5e-11));  // ten digits are printed [Sonnleitner2010, p. 39]
}

TEST(Problems, InverseMassMatrixIsTheHessianOfTheKineticEnergy) {
  const auto coupled = natural<2>([](const auto& p) { return (p[0] * p[0] + p[0] * p[1] + 2.0 * p[1] * p[1]) / 2.0; },
                                  [](const auto& q) { return q[0] * q[1]; });
  const Matrix<double, 2> m = inverse_mass_matrix(coupled);
  EXPECT_EQ(m, (Matrix<double, 2>{Vector<double, 2>{1.0, 0.5}, Vector<double, 2>{0.5, 2.0}}));
}

const auto pendulum_parts = [] {
  return natural<1>([](const auto& p) { return p[0] * p[0] / 2.0; }, [](const auto& q) { return -cos(q[0]); });
};

TEST(OwnProblem, FromLambdasGivesTheBitsOfTheCatalogueProblem) {
  const auto own = pendulum_parts();
  auto a = simulate(own, Composition<compositions::stv4>{}, {2.0}, {0.5}, 0.1);
  auto b = simulate(Pendulum<double>(), Composition<compositions::stv4>{}, {2.0}, {0.5}, 0.1);
  ASSERT_EQ(a.advance(100), Outcome::done);
  ASSERT_EQ(b.advance(100), Outcome::done);
  // The same operations but for the sign of zero and the order of factors 1: a few roundings over 100 steps.
  EXPECT_TRUE(test::within(a.state().q[0], b.state().q[0], 1e4L * test::epsilon));
  EXPECT_TRUE(test::within(a.state().p[0], b.state().p[0], 1e4L * test::epsilon));
}

TEST(OwnProblem, AWholeHamiltonianRunsWithRungeKutta) {
  // H(q, p) of the pendulum, not declared separable: its gradient comes from dual numbers.
  const auto whole = hamiltonian<1>([](const auto& q, const auto& p) { return p[0] * p[0] / 2.0 - cos(q[0]); });
  static_assert(Differentiable<decltype(whole)> && !Separable<decltype(whole)>);
  auto a = simulate(whole, RungeKuttaBy<tableaus::rk4>{}, {2.0}, {0.5}, 0.1);
  auto b = simulate(Pendulum<double>(), RungeKuttaBy<tableaus::rk4>{}, {2.0}, {0.5}, 0.1);
  ASSERT_EQ(a.advance(100), Outcome::done);
  ASSERT_EQ(b.advance(100), Outcome::done);
  EXPECT_TRUE(test::within(a.state().q[0], b.state().q[0], 1e4L * test::epsilon));
  EXPECT_EQ(a.effort().gradient, 400);
  EXPECT_EQ(b.effort().force, 400);
}

TEST(OwnProblem, SeparableIsNotNatural) {
  const auto relativistic = separable<1>([](const auto& p) { return sqrt(1.0 + p[0] * p[0]); },
                                         [](const auto& q) { return q[0] * q[0] / 2.0; });
  static_assert(Separable<decltype(relativistic)> && !QuadraticKinetic<decltype(relativistic)>);
  static_assert(QuadraticKinetic<decltype(pendulum_parts())>);
  Vector<double, 1> v{};
  velocity(relativistic, Vector<double, 1>{0.75}, v);
  EXPECT_TRUE(test::same_to_rounding(v[0], 0.6, 4.0));  // p/sqrt(1 + p^2)
}

}  // namespace
}  // namespace hamflow
