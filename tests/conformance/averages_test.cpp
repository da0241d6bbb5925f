// Elements of any degree and Gauss collocation: several unknowns, solvers and iterations for one map.
#include "hamflow/methods/averages.hpp"

#include "../support/allocations.hpp"
#include "../support/near.hpp"
#include "engine/step_map_of.hpp"
#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/problems/pendulum.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/problems/support/from_functions.hpp"
#include "hamflow/problems/support/polar.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace hamflow {
namespace {

using Plane = CentralForce<double, Kepler>;
using Polar = PolarCentralForce<double, Kepler>;
using Double = DoublePendulumNonlinearAbsolute<double>;

static_assert(StepEquations<NaturalAverages<Plane, double>>);
static_assert(StepEquations<CyclicAverages<Polar, double>>);
static_assert(StepEquations<GeneralAverages<Double, double>>);

/// A solver of our choice.
template <class Element>
struct AveragesBy : Averages {
  template <class P, class A>
  using Stepper = ImplicitMethod<P, A, Element>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, options);
  }
};

Frame end_of(Simulation& simulation, int steps) {
  EXPECT_EQ(simulation.advance(steps), Outcome::done) << simulation.failure();
  Frame frame;
  simulation.look(frame);
  return frame;
}
double difference(const Frame& a, const Frame& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.q.size(); ++i) {
    largest = std::max({largest, std::fabs(a.q[i] - b.q[i]), std::fabs(a.p[i] - b.p[i])});
  }
  return largest;
}

/// Three problems, one for each way to solve: a step of rounding is a few epsilon, and grows with the square of the
/// number of steps at most on these regular orbits.
template <class A, class B>
void expect_one_map(const A& first, const B& second, const std::string& what) {
  SCOPED_TRACE(what);
  constexpr int steps = 40;
  constexpr double bound = steps * steps * test::epsilon;
  const auto on = [&](const auto& problem, const Vector<double, 2>& q, const Vector<double, 2>& p, double h,
                      double size) {
    auto a = simulate(problem, first, q, p, h);
    auto b = simulate(problem, second, q, p, h);
    EXPECT_LE(difference(end_of(a, steps), end_of(b, steps)), bound * size);
  };
  on(Plane(1.0, Kepler<double>(1.0)), {1.0, 0.0}, {0.1, 1.1}, 0.1, 1);
  on(Polar(1.0, Kepler<double>(1.0)), {1.0, 0.0}, {0.1, 1.1}, 0.1, 4);
  on(Double(), {0.7, -0.5}, {1.5, 0.6}, 0.01, 16);  // H is of size 40
}

TEST(Averages, OfDegreeOneSolveWhatTheElementOfDegreeOneSolves) {
  for (const int points : {1, 2, 5, 12}) {
    expect_one_map(Cg{{.quadrature = points}}, CgOfDegree{{.quadrature = points}}, std::to_string(points));
  }
}

TEST(Averages, StagesAreTheMapOfElementsWithAsManyPoints) {
  for (int k = 1; k <= 10; ++k) {
    expect_one_map(Gauss{{.stages = k}}, CgOfDegree{{.degree = k, .quadrature = k}}, std::to_string(k));
  }
}

TEST(Averages, EveryIterationSolvesTheSameEquations) {
  for (const int k : {1, 2, 4}) {
    for (const int points : {k, 2 * k + 3}) {
      CgOptions options{.degree = k, .quadrature = points, .max_iterations = 100};
      const CgOfDegree newton(options);
      options.iteration = Iteration::simplified;
      expect_one_map(newton, CgOfDegree(options), "simplified");
      options.iteration = Iteration::fixed_point;
      expect_one_map(newton, CgOfDegree(options), "fixed-point");
    }
    GaussOptions options{.stages = k, .max_iterations = 100, .iteration = Iteration::fixed_point};
    expect_one_map(Gauss(options), Gauss{{.stages = k}}, "stages");
  }
}

TEST(Averages, NewtonInPartOfThemSolvesWhatNewtonInAllSolves) {
  for (const bool stages : {false, true}) {
    AverageOptions options =
        stages ? AverageOptions(GaussOptions{.stages = 3}) : AverageOptions(CgOptions{.degree = 3, .quadrature = 7});
    const Plane plane(1.0, Kepler<double>(1.0));
    auto natural = simulate(plane, Averages{options}, {1.0, 0.0}, {0.1, 1.1}, 0.1);
    auto general = simulate(plane, AveragesBy<GeneralAverages<Plane, double>>{options}, {1.0, 0.0}, {0.1, 1.1}, 0.1);
    EXPECT_LE(difference(end_of(natural, 100), end_of(general, 100)), 1e4 * test::epsilon);
    const Polar polar(1.0, Kepler<double>(1.0));
    auto closed = simulate(polar, Averages{options}, {1.0, 0.0}, {0.1, 1.1}, 0.1);
    auto whole = simulate(polar, AveragesBy<GeneralAverages<Polar, double>>{options}, {1.0, 0.0}, {0.1, 1.1}, 0.1);
    EXPECT_LE(difference(end_of(closed, 100), end_of(whole, 100)), 4e4 * test::epsilon);
    EXPECT_EQ(closed.state().p[1].high, 1.1) << "p_phi is constant by construction, to the last bit";
  }
}

/// A problem without second derivatives.
struct FirstDerivativesOnly {
  using Real = double;
  static constexpr std::size_t dimension = 1;
  double energy(const Vector<double, 1>& q, const Vector<double, 1>& p) const {
    return p[0] * p[0] / 2 - std::cos(q[0]);
  }
  void gradient(const Vector<double, 1>& q, const Vector<double, 1>& p, Vector<double, 1>& dq,
                Vector<double, 1>& dp) const {
    dq[0] = std::sin(q[0]);
    dp[0] = p[0];
  }
};

TEST(Averages, AFixedPointIterationAsksForFirstDerivativesOnly) {
  static_assert(!Smooth<FirstDerivativesOnly>);
  const FirstDerivativesOnly problem;
  CgOptions options{.degree = 2, .quadrature = 8, .max_iterations = 100, .iteration = Iteration::fixed_point};
  auto run = simulate(problem, CgOfDegree(options), {1.0}, {0.5}, 0.1);
  ASSERT_EQ(run.advance(1000), Outcome::done) << run.failure();
  EXPECT_LE(run.energy().max_error, 64 * test::epsilon);
  EXPECT_EQ(run.effort().hessian, 0);
  options.iteration = Iteration::newton;
  EXPECT_THROW((void)simulate(problem, CgOfDegree(options), {1.0}, {0.5}, 0.1), Error);
  EXPECT_THROW((void)simulate(HenonHeiles<double>(), Cg{{.degree = 2}}, {0.1, 0.1}, {0.1, 0.1}, 0.1), Error);
}

TEST(Averages, MuIsAntisymmetricAboutOneHalfToTheLastBit) {
  const auto check = []<class R>(const char* arithmetic) {
    for (int k = 1; k <= 10; ++k) {
      const AverageTable<R>& t = stage_table<R>(k);
      const auto n = static_cast<std::size_t>(k);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
          // mu = 1/2 + N, so that mu_ij + mu_ji = 1 as real numbers.
          EXPECT_TRUE(t.inner[i * n + j] == -t.inner[j * n + i]) << arithmetic << ", " << k;
          EXPECT_TRUE(t.coupling[j * n + i] == t.inner[i * n + j]);
          // And the step seen from its end is the step.
          EXPECT_TRUE(t.inner[i * n + j] == -t.inner[(n - 1 - i) * n + n - 1 - j]) << arithmetic << ", " << k;
        }
        EXPECT_TRUE(t.scale[i] == t.weight[i * n + i]);
      }
    }
  };
  check.operator()<double>("double");
  check.operator()<long double>("long double");
  check.operator()<DoubleDouble>("double-double");
  check.operator()<Quad>("quad");
  const MpDigits scope(50);
  check.operator()<Mp>("mp(50)");
}

TEST(Averages, CoefficientsAreThoseOfCollocation) {
  // a_ij = b_j mu_ij: sum_j a_ij c_j^(m - 1) = c_i^m/m, m = 1 .. k  [HLW2006, II.1.3], in 45 digits.
  const MpDigits scope(45);
  for (int k = 1; k <= 10; ++k) {
    const auto n = static_cast<std::size_t>(k);
    const AverageTable<Mp>& t = stage_table<Mp>(k);
    const GaussRule<Mp>& rule = gauss_rule<Mp>(k);
    for (std::size_t i = 0; i < n; ++i) {
      for (int m = 1; m <= k; ++m) {
        Mp sum(0);
        Mp power(1);
        for (int e = 0; e < m; ++e) power *= rule.c[i];
        for (std::size_t j = 0; j < n; ++j) {
          Mp each = rule.b[j] * (Mp(0.5) + t.inner[j * n + i]);
          for (int e = 1; e < m; ++e) each *= rule.c[j];
          sum += each;
        }
        EXPECT_LT(static_cast<double>(abs(sum - power / Mp(m))), 1e-42) << k << ", " << m;
      }
    }
  }
}

TEST(Averages, OrdersAreTwiceTheDegreeWhateverTheNumberOfPoints) {
  // In quad, where four halvings of order 12 lead from 8 digits to 22. Coarse steps of high order are not counted.
  for (int k = 1; k <= 6; ++k) {
    for (const int points : {k, k + 1, 2 * k, 3 * k}) {
      const StepMapOf<Pendulum, Averages, Beyond::quad> map([]<class R>() { return Pendulum<R>(); },
                                                            CgOfDegree{{.degree = k, .quadrature = points}});
      const State<Quad> start{Quad(1.2), Quad(0.5)};
      const State<Quad> exact = map.flow(start, Quad(1));
      double previous = 0;
      std::printf("  cg(%d,%d):", k, points);
      for (int steps = 2; steps <= 32; steps *= 2) {
        State<Quad> z = start;
        ASSERT_TRUE(map.advance(z, Quad(1) / Quad(steps), steps));
        const Quad off = larger(Quad(abs(z[0] - exact[0])), Quad(abs(z[1] - exact[1])));
        const double digits = std::log2(static_cast<double>(off));
        if (previous < 0) {
          std::printf(" %.3f", previous - digits);
          EXPECT_NEAR(previous - digits, 2 * k, steps == 4 ? 2.0 : 0.15) << k << ", " << points << ", " << steps;
        }
        previous = digits;
      }
      std::printf("\n");
    }
  }
}

TEST(Averages, WhatIsRememberedIsArchivedAndNothingIsAllocated) {
  const Plane problem(1.0, Kepler<double>(1.0));
  for (const Averages& recipe :
       {Averages(CgOfDegree{{.degree = 2}}), Averages(CgOfDegree{{.degree = 3, .quadrature = 6}}),
        Averages(Gauss{{.stages = 4}}),
        Averages(Gauss{{.stages = 3, .max_iterations = 100, .iteration = Iteration::fixed_point}}),
        Averages(
            CgOfDegree{{.degree = 2, .quadrature = 4, .max_iterations = 100, .iteration = Iteration::simplified}})}) {
    const auto make = [&] { return simulate(problem, recipe, {0.4, 0.0}, {0.0, 2.0}, 0.05); };
    auto whole = make();
    SCOPED_TRACE(whole.method().name);
    // What is remembered is copied where a block of steps begins: the pool has a vector for that from the second one
    // on.
    for (int block = 0; block < 3; ++block) ASSERT_EQ(whole.advance(50), Outcome::done) << whole.failure();
    const auto saved = whole.save();
    const long long before = test::allocations();
    ASSERT_EQ(whole.advance(150), Outcome::done);
    if (test::counts_allocations()) {
      EXPECT_EQ(test::allocations() - before, 0);
    }
    auto resumed = make();
    resumed.restore(saved);
    EXPECT_EQ(resumed.save(), saved);
    ASSERT_EQ(resumed.advance(150), Outcome::done);
    EXPECT_EQ(resumed.save(), whole.save());
  }
}

TEST(Averages, HalvingAndReversalForgetTheLastStep) {
  // Which shows in what is saved: the averages of the last step are not among it.
  const Plane problem(1.0, Kepler<double>(1.0));
  auto run = simulate(problem, CgOfDegree{{.degree = 2, .quadrature = 5}}, {1.0, 0.0}, {0.0, 1.2}, 0.1);
  const std::size_t nothing = run.save().size();
  ASSERT_EQ(run.advance(20), Outcome::done);
  EXPECT_EQ(run.save().size(), nothing + 4 * sizeof(double));
  run.negate_momenta();
  EXPECT_EQ(run.save().size(), nothing);
  ASSERT_EQ(run.advance(20), Outcome::done);
  EXPECT_NEAR(run.state().q[0].high, 1.0, 400 * test::epsilon);
  run.reverse_time();
  EXPECT_EQ(run.save().size(), nothing);

  // Through the pericentre of a long ellipse with a step that is too long for it.
  auto halving =
      simulate(problem, CgOfDegree{{.degree = 2, .quadrature = 20, .halve = true}}, {1.0, 0.0}, {0.0, 0.2}, 0.3);
  ASSERT_EQ(halving.advance(60), Outcome::done) << halving.failure();
  EXPECT_GT(halving.effort().halved, 0);
}

TEST(Averages, TheFirstGuessContinuesThePolynomialOfTheLastStep) {
  // A polynomial of degree k, at most most_continued, is continued exactly: the averages of free fall, and of a motion
  // z'(t) of degree k - 1.
  for (const int k : {1, 2, 3, 5, 8, 9, 10}) {
    const int degree = std::min(k, detail::most_continued) - 1;
    const auto n = static_cast<std::size_t>(k);
    for (const bool stages : {false, true}) {
      const AverageTable<double>& t = stages ? stage_table<double>(k) : element_table<double>(k, k);
      const GaussRule<double>& rule = gauss_rule<double>(k);
      // z' = (1 + c)^(k - 1) at the points of a step and, c + 1, of the one after it.
      const auto averages = [&](double from) {
        std::vector<double> u(n);
        for (std::size_t l = 0; l < n; ++l) {
          for (std::size_t i = 0; i < n; ++i)
            u[i] += t.weight[l * n + i] * std::pow((1 + from + rule.c[l]) / 3, degree);
        }
        return u;
      };
      const std::vector<double> before = averages(0);
      const std::vector<double> wanted = averages(1);
      Vector<double, dynamic> last(n);
      std::copy(before.begin(), before.end(), last.begin());
      const auto guess = detail::continued(t, last);
      for (std::size_t i = 0; i < n; ++i) {
        EXPECT_NEAR(guess[i], wanted[i], 16 * test::epsilon * std::pow(6, degree + 1))
            << k << (stages ? " stages" : "");
      }
    }
  }
  // Which spares corrections: each gains the same number of digits.
  const Plane problem(1.0, Kepler<double>(1.0));
  const auto solves = [&](bool remembering) {
    const CgOptions options{.degree = 3, .quadrature = 6, .max_iterations = 100, .iteration = Iteration::fixed_point};
    auto method = CgOfDegree{options}.bind<Plane, Compensated<double>>(problem);
    PhasePoint<Compensated<double>, 2> z;
    z.store({1.0, 0.0}, {0.0, 1.1});
    for (int i = 0; i < 40; ++i) {
      if (!remembering) method.invalidate();
      EXPECT_EQ(method.step(problem, 0.1, z), Outcome::done);
    }
    return method.effort().linear_solves;
  };
  EXPECT_LT(solves(true), solves(false));
}

/// An archive that takes one thing of what a method saves: its number of Gauss points.
struct PointsInUse {
  static constexpr bool reading = false;
  int points = 0;
  template <class... T>
  void operator()(T&... each) {
    (take(each), ...);
  }
  void take(int& found) { points = found; }
  template <class T>
  void take(T& part) {
    if constexpr (requires { part.current_rule(); }) part.archive(*this);
  }
};

TEST(Averages, PointsOfAutoBelongToStepsOfOneLength) {
  using A = Compensated<double>;
  const Plane problem(1.0, Kepler<double>(1.0));
  const auto check = [&](auto method, int fewest) {
    const auto points = [&] {
      PointsInUse found;
      method.archive(found);
      return found.points;
    };
    PhasePoint<A, 2> z;
    z.store({1.0, 0.0}, {0.0, 0.2});
    EXPECT_EQ(points(), fewest);
    ASSERT_EQ(method.step(problem, 0.1, z), Outcome::done);
    const int found = points();
    EXPECT_GT(found, fewest);
    method.invalidate();  // as a reversal does
    EXPECT_EQ(points(), fewest);
    // Through the pericentre with steps that are too long for it: those of the halves are not those of whole steps.
    int before = points();
    int steps = 0;
    while (method.effort().halved == 0 && ++steps < 60) {
      before = points();
      ASSERT_EQ(method.step(problem, 0.3, z), Outcome::done);
    }
    EXPECT_EQ(method.effort().halved, 1);
    EXPECT_EQ(points(), before);
  };
  const CgOptions one{.halve = true};
  const CgOptions two{.degree = 2, .halve = true};
  check(Cg{one}.bind<Plane, A>(problem), 1);
  check(Averages{two}.bind<Plane, A>(problem), 2);
  check(AveragesBy<GeneralAverages<Plane, double>>{{two}}.bind<Plane, A>(problem), 2);
}

/// H = p^2/2 + |q|, whose force jumps.
struct Kinked {
  using Real = double;
  static constexpr std::size_t dimension = 1;
  static constexpr bool quadratic_kinetic = true;
  template <class S>
  S kinetic(const Vector<S, 1>& p) const {
    return p[0] * p[0] / 2.0;
  }
  template <class S>
  S potential(const Vector<S, 1>& q) const {
    return abs(q[0]);
  }
};

TEST(Averages, AKinkThatNoPointSeesIsNotPassedOver) {
  // One point and two agree about a force that jumps beyond both: the energy would go step by step, unnoticed.
  const auto check = [](const auto& recipe) {
    auto run = simulate(Kinked{}, recipe, {1.0}, {0.3}, 0.1);
    EXPECT_EQ(run.advance(1000), Outcome::not_converged);
    EXPECT_LE(run.energy().max_error, 64 * test::epsilon);
    auto one_step = simulate(Kinked{}, recipe, {0.002}, {-1.0}, 0.1);
    EXPECT_EQ(one_step.advance(1), Outcome::not_converged);
    EXPECT_NE(one_step.failure().find("H has a kink or a jump there"), std::string::npos);
  };
  check(Cg{});
  check(CgOfDegree{{.degree = 2}});
  check(AveragesBy<GeneralAverages<Kinked, double>>{{CgOptions{.degree = 3}}});
}

TEST(Averages, SixtyFourPointsAreTheMost) {
  const Plane problem(1.0, Kepler<double>(1.0));
  for (const int degree : {1, 2, 10, 30, 63}) {
    auto run = simulate(problem, CgOfDegree{{.degree = degree, .quadrature = 64}}, {0.4, 0.0}, {0.0, 2.0}, 0.1);
    ASSERT_EQ(run.advance(degree < 30 ? 63 : 2), Outcome::done) << run.failure();
    EXPECT_LE(run.energy().max_error, 32 * test::epsilon) << degree;
  }
  auto one = simulate(problem, Cg{{.quadrature = 64}}, {0.4, 0.0}, {0.0, 2.0}, 0.1);
  ASSERT_EQ(one.advance(63), Outcome::done);
  EXPECT_LE(one.energy().max_error, 32 * test::epsilon);
}

}  // namespace
}  // namespace hamflow
