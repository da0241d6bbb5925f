// Gradients and Hessians written by hand against dual numbers; problems given as lambdas.
#include <array>

#include "../support/near.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/runge_kutta.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/tableaus/rk4.hpp"
#include "hamflow/problems/support/from_functions.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/simulation_of.hpp"
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

/// Parameters different from 1 and from each other, so that a forgotten one shows.
Texts uncommon_parameters(const ProblemInfo& info) {
  Texts texts;
  int k = 0;
  const auto next = [&] { return std::to_string(1.3 + 0.4 * k++); };
  for (const ParameterInfo& p : info.parameters) {
    if (info.name == "duffing" && (p.name == "k" || p.name == "lambda")) continue;  // instead of alpha and beta
    if (p.range.whole) {
      texts[p.name] = "4";
    } else if (p.type == OptionType::number) {
      texts[p.name] = next();
    } else {
      const std::size_t length = p.length > 0 ? p.length : 3;
      for (std::size_t i = 0; i < length; ++i) texts[p.name] += (i == 0 ? "[" : ", ") + next();
      texts[p.name] += "]";
    }
  }
  return texts;
}

template <template <class> class Family, class R>
Family<R> make(const Texts& texts, [[maybe_unused]] std::size_t size) {
  if constexpr (Family<R>::dimension == dynamic) {
    return Family<R>(Parameters<R>(texts), size);
  } else {
    return Family<R>(Parameters<R>(texts));
  }
}

/// The numbers of coordinates that a problem can have.
template <template <class> class Family>
std::vector<std::size_t> sizes(const Texts& texts) {
  if constexpr (Family<double>::dimension != dynamic) {
    return {Family<double>::dimension};
  } else {
    std::vector<std::size_t> all;
    for (std::size_t size = 1; size <= 18; ++size) {
      if (Family<double>::refused_size(Parameters<double>(texts), size).empty()) all.push_back(size);
    }
    return all;
  }
}

/// A state without zeros, away from a singularity at 0.
template <std::size_t n>
void random_state(std::uint64_t trial, Vector<double, n>& q, Vector<double, n>& p) {
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] = 1.1 + 0.6 * counter_uniform(21, (2 * trial) * q.size() + i);
    p[i] = 1.5 * counter_uniform(21, (2 * trial + 1) * q.size() + i);
  }
}

/// The derivative of f along coordinate k of (q, p), by dual numbers in long double.
template <std::size_t n, class F>
auto along(std::size_t k, const Vector<double, n>& q, const Vector<double, n>& p, const F& f) {
  using D = Dual<long double, 1>;
  auto dual_q = zeros<D, n>(q.size());
  auto dual_p = dual_q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    dual_q[i] = static_cast<long double>(q[i]);
    dual_p[i] = static_cast<long double>(p[i]);
  }
  (k < q.size() ? dual_q[k] : dual_p[k - q.size()]).slope[0] = 1;
  return f(dual_q, dual_p);
}

/// Gradient and Hessian by hand against derivatives of H, and of the gradient, by dual numbers. Bounds: a relative
/// rounding of the coordinates, which is V'' |q| epsilon, and some roundings of the result.
template <template <class> class Family>
void derivatives_are_those_of_the_energy() {
  constexpr std::size_t n = Family<double>::dimension;
  const ProblemInfo info = Family<double>::info();
  SCOPED_TRACE(info.name + ": " + info.formula);
  const Texts texts = uncommon_parameters(info);
  for (const std::size_t size : sizes<Family>(texts)) {
    const auto problem = make<Family, double>(texts, size);
    const auto exact = make<Family, long double>(texts, size);
    for (std::uint64_t trial = 0; trial < 50; ++trial) {
      auto q = zeros<double, n>(size);
      auto p = q;
      random_state(trial, q, p);
      auto dq = q;
      auto dp = q;
      auto qq = zero_matrix(q);
      auto qp = qq;
      auto pp = qq;
      gradient(problem, q, p, dq, dp);
      hessian(problem, q, p, qq, qp, pp);
      const auto second = [&](std::size_t i, std::size_t j) {
        if (i < size) return j < size ? qq[i][j] : qp[i][j - size];
        return j < size ? qp[j][i - size] : pp[i - size][j - size];
      };
      for (std::size_t k = 0; k < 2 * size; ++k) {
        long double units = 0;  // what rounded coordinates, and the rounded parameters of the double problem, change
        for (std::size_t j = 0; j < 2 * size; ++j) units += std::fabs(second(k, j)) * 4;
        const long double slope =
            along(k, q, p, [&](const auto& x, const auto& y) { return energy(exact, x, y).slope[0]; });
        EXPECT_TRUE(
            test::within(k < size ? dq[k] : dp[k - size], slope, 64 * test::epsilon * (std::fabs(slope) + units)))
            << "dH/dz_" << k;
        const auto column = along(k, q, p, [&](const auto& x, const auto& y) {
          auto by_q = zeros_like(x);
          auto by_p = by_q;
          gradient(exact, x, y, by_q, by_p);
          std::vector<long double> all;
          for (const auto& d : by_q) all.push_back(d.slope[0]);
          for (const auto& d : by_p) all.push_back(d.slope[0]);
          return all;
        });
        for (std::size_t i = 0; i < 2 * size; ++i) {
          EXPECT_TRUE(test::within(second(i, k), column[i], 1024 * test::epsilon * (units + std::fabs(slope))))
              << "d2H/dz_" << i << "dz_" << k;
        }
      }
    }
  }
}

/// What a separable problem gives by hand is one thing in several shapes.
template <template <class> class Family>
void parts_agree() {
  if constexpr (Separable<Family<double>>) {
    constexpr std::size_t n = Family<double>::dimension;
    const Texts texts = uncommon_parameters(Family<double>::info());
    for (const std::size_t size : sizes<Family>(texts)) {
      const auto problem = make<Family, double>(texts, size);
      auto q = zeros<double, n>(size);
      auto p = q;
      random_state(3, q, p);
      auto f = q;
      auto v = q;
      auto both_f = q;
      auto dq = q;
      auto dp = q;
      auto second = zero_matrix(q);
      auto both_second = second;
      std::array<decltype(q), 4> scaled{q, q, q, q};
      scaled_force(problem, 0.3, q, scaled[0]);
      scaled_force(problem, -0.3, q, scaled[1]);
      scaled_velocity(problem, 0.3, p, scaled[2]);
      scaled_velocity(problem, -0.3, p, scaled[3]);
      force(problem, q, f);
      velocity(problem, p, v);
      potential_hessian(problem, q, second);
      force_and_hessian(problem, q, both_f, both_second);
      gradient(problem, q, p, dq, dp);
      for (std::size_t i = 0; i < size; ++i) {
        const long double bound = 64 * test::epsilon * (std::fabs(f[i]) + std::fabs(second[i][i]) * std::fabs(q[i]));
        EXPECT_EQ(dq[i], -f[i]);
        EXPECT_EQ(dp[i], v[i]);
        EXPECT_TRUE(test::within(both_f[i], f[i], bound));
        EXPECT_TRUE(test::within(scaled[0][i], 0.3 * f[i], 0.3 * bound));
        EXPECT_TRUE(test::same_to_rounding(scaled[2][i], 0.3 * v[i], 4.0));
        EXPECT_EQ(scaled[1][i], -scaled[0][i]);  // or the lattice would not return
        EXPECT_EQ(scaled[3][i], -scaled[2][i]);
        for (std::size_t j = 0; j < size; ++j) {
          EXPECT_TRUE(test::within(both_second[i][j], second[i][j], 16 * bound));
        }
      }
      EXPECT_TRUE(test::within(energy(problem, q, p), problem.kinetic(p) + problem.potential(q), 0));
    }
  }
}

TEST(Problems, TheShapesOfTheDerivativesAgree) {
#define HAMFLOW_CHECK(Family) parts_agree<Family>();
  HAMFLOW_FOR_EACH_PROBLEM(HAMFLOW_CHECK)
#undef HAMFLOW_CHECK
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

TEST(OwnProblem, NaturalNeedsAQuadraticKineticEnergy) {
  const auto spring = [](const auto& q) { return q[0] * q[0]; };
  EXPECT_THROW((void)natural<1>([](const auto& p) { return p[0] * p[0] * p[0] * p[0]; }, spring), Error);
  EXPECT_THROW((void)natural<1>([](const auto& p) { return p[0] * p[0] / 2.0 + p[0]; }, spring), Error);
  EXPECT_THROW((void)natural<2>([](const auto& p) { return abs(p[0] * p[1]); }, spring), Error);
  (void)natural<2>([](const auto& p) { return p[0] * p[0] / 1e7 + p[1] * p[1] + 1e-5 * (p[0] * p[1]); }, spring);
}

TEST(OwnTable, KicksAndDriftsAddUpToOne) {
  static constexpr SplittingTable nine_tenths{.name = "nine-tenths",
                                              .order = 2,
                                              .reference = "none",
                                              .starts_with = StartsWith::kick,
                                              .symmetric = true,
                                              .coefficients = {"0.45", "1"}};
  static_assert(!nine_tenths.is_consistent() && plain_number("-1/8") == -0.125);
  const TableRecipe<Shape::any> recipe{AnySplitting(nine_tenths)};
  EXPECT_THROW((void)simulate(Pendulum<double>(), recipe, {2.0}, {0.5}, 0.1), Error);
}

}  // namespace
}  // namespace hamflow
