// Newton's starts on stiff steps, what a failure reports, and a second method from the equations of its steps.
#include "../support/allocations.hpp"
#include "../support/near.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/problems/potentials/binomial.hpp"
#include "hamflow/problems/support/polar.hpp"
#include "mutants/examine.hpp"
#include "mutants/gauss_two.hpp"

namespace hamflow {
namespace {

using A = Compensated<double>;
using Plane = CentralForce<double, Binomial>;
using Polar = PolarCentralForce<double, Binomial>;

static_assert(StepEquations<NaturalElement<Plane, double>>);
static_assert(StepEquations<CyclicElement<Polar, double>>);
static_assert(StepEquations<GeneralElement<Polar, double>>);
static_assert(StepEquations<mutants::GaussTwo<Plane, double>>);

/// What the steps of a stiff run came to.
struct Course {
  int steps = 0;
  double error = 0;                             // of the energy, the largest, over the scale
  long long first = 0, least = 1000, most = 0;  // linear solves of the first step, and of the others
  long long total = 0;
  long long allocations = 0;
};

/// Appendix D of the first thesis: mass 2, lambda 1, 0.9 <= r <= 1.1, from pericentre.
template <class Method, class P>
Course stiff_run(const P& problem, Method method, PhasePoint<A, 2> z, double h, int steps) {
  const double initial = energy(problem, z.positions(), z.momenta());
  Course course;
  for (; course.steps < steps; ++course.steps) {
    const long long before = method.effort().linear_solves;
    const long long allocated = test::allocations();
    if (method.step(problem, h, z) != Outcome::done) break;
    course.allocations += test::allocations() - allocated;
    const long long solves = method.effort().linear_solves - before;
    if (course.steps == 0) {
      course.first = solves;
    } else {
      course.least = std::min(course.least, solves);
      course.most = std::max(course.most, solves);
    }
    course.total += solves;
    course.error = std::max(course.error, std::fabs(energy(problem, z.positions(), z.momenta()) - initial) / initial);
  }
  return course;
}
double stiff_momentum(double k) { return 0.9 * 1.1 * std::sqrt(2 * 2 * k * ((0.81 + 1.21) / 2 - 1)); }
PhasePoint<A, 2> stiff_start(double k, bool polar) {
  PhasePoint<A, 2> z;
  z.store({0.9, 0.0}, {0.0, polar ? stiff_momentum(k) : stiff_momentum(k) / 0.9});
  return z;
}
template <class P>
P stiff_problem(double k) {
  return P(2.0, Binomial<double>(k, 1.0));
}

constexpr std::pair<double, double> stiff_cases[] = {{1e3, 0.1}, {1e6, 0.1}, {1e6, 0.01}, {1e6, 0.001}};
constexpr int stiff_steps = 400;
/// Rounding of one step in units of epsilon H, H = 0.030 k. The residual's, work times 2 (flight and displacement), at
/// most 8 T: 8. A position rounds by epsilon, at which the force k 2 (r^2 - 1) r changes by 4 k epsilon: along a
/// displacement of 0.2 that is 27 H epsilon of work; and where H is read, |V'| epsilon <= 0.4 k epsilon, 13. Together
/// 48, a random walk.
const double walk = 48 * std::sqrt(stiff_steps) * test::epsilon;

void expect_calm(const Course& course, double bound) {
  EXPECT_EQ(course.steps, stiff_steps);
  EXPECT_LE(course.error, bound);
  // A start may fail when the first two steps find out that guesses are of no use. The first thesis' program, which
  // always starts from the last state, needs 4 to 13 iterations.
  EXPECT_LE(course.first, 2 * 15 + 13);
  EXPECT_LE(course.most, 15 + 13);
  EXPECT_LE(course.total, 13 * stiff_steps);
  if (test::counts_allocations()) {
    EXPECT_EQ(course.allocations, 0);
  }
}
void show(const char* where, double k, double h, const Course& c) {
  std::cout << where << " k = " << k << ", dt = " << h << ": " << c.steps << " steps, energy " << c.error
            << ", Newton first " << c.first << ", then " << c.least << " to " << c.most << ", mean "
            << static_cast<double>(c.total) / std::max(c.steps, 1) << '\n';
}

TEST(Newton, StiffSpringInCartesianCoordinates) {
  for (const auto& [k, h] : stiff_cases) {
    SCOPED_TRACE(k * h);
    const auto problem = stiff_problem<Plane>(k);
    const Course course = stiff_run(problem, ContinuousGalerkin<Plane, A>(problem, {.quadrature = 5}),
                                    stiff_start(k, false), h, stiff_steps);
    show("cartesian, 5 points,", k, h, course);
    expect_calm(course, walk);
  }
}

TEST(Newton, StiffSpringInPolarCoordinates) {
  // Extrapolated, the radius goes through the centre, where Newton finds roots of another motion.
  for (const auto& [k, h] : stiff_cases) {
    SCOPED_TRACE(k * h);
    const auto problem = stiff_problem<Polar>(k);
    for (const int points : {5, 6}) {
      const Course course = stiff_run(problem, ContinuousGalerkin<Polar, A>(problem, {.quadrature = points}),
                                      stiff_start(k, true), h, stiff_steps);
      show(points == 5 ? "polar, 5 points," : "polar, 6 points,", k, h, course);
      // l^2/(2 mu r^2) is analytic but at r = 0, ten half lengths from the middle of the segment: Gauss' error of a
      // step is below (64/15) rho^(-2 s) of it, rho = 10 + sqrt(99).
      const double quadrature = 64.0 / 15 * std::pow(10 + std::sqrt(99.0), -2 * points);
      expect_calm(course, walk + stiff_steps * quadrature);
    }
  }
}

TEST(Newton, StiffSpringByTheGeneralWay) {
  for (const auto& [k, h] : stiff_cases) {
    SCOPED_TRACE(k * h);
    const auto problem = stiff_problem<Plane>(k);
    const Course course =
        stiff_run(problem, ContinuousGalerkin<Plane, A, GeneralElement<Plane, double>>(problem, {.quadrature = 5}),
                  stiff_start(k, false), h, stiff_steps);
    show("cartesian, general,", k, h, course);
    expect_calm(course, walk);
  }
}

/// A mutant: there is no last state to start from.
template <class P, class R>
struct WithoutLastState : NaturalElement<P, R> {
  using NaturalElement<P, R>::NaturalElement;
  Vector<R, P::dimension> last_state() const {
    Vector<R, P::dimension> nowhere{};
    for (R& x : nowhere) x = std::numeric_limits<R>::quiet_NaN();
    return nowhere;
  }
};

TEST(Newton, WithoutItsStartsTheStiffRunsTakeTheLongWay) {
  // From the solutions of parts of the step, which need no other start.
  for (const auto& [k, h] : stiff_cases) {
    if (h == 0.001) continue;  // the step follows the motion: extrapolation does
    const auto problem = stiff_problem<Plane>(k);
    const Course course =
        stiff_run(problem, ContinuousGalerkin<Plane, A, WithoutLastState<Plane, double>>(problem, {.quadrature = 5}),
                  stiff_start(k, false), h, stiff_steps);
    show("mutant without the last state,", k, h, course);
    EXPECT_EQ(course.steps, stiff_steps);
    EXPECT_LE(course.error, walk);
    EXPECT_GT(course.most, 15 + 13) << "it would do without";
  }
}

/// V = k (x atan x - ln(1 + x^2)/2): V' = k atan x, for which Newton diverges from |x| > 1.39 on.
struct FlatWell {
  using Real = double;
  static constexpr std::size_t dimension = 1;
  static constexpr bool quadratic_kinetic = true;
  double k;
  template <class S>
  S kinetic(const Vector<S, 1>& p) const {
    return p[0] * p[0] / 2;
  }
  template <class S>
  S potential(const Vector<S, 1>& q) const {
    return k * (q[0] * atan(q[0]) - log(1 + q[0] * q[0]) / 2);
  }
  template <class S>
  void velocity(const Vector<S, 1>& p, Vector<S, 1>& v) const {
    v = p;
  }
  template <class S>
  void force(const Vector<S, 1>& q, Vector<S, 1>& f) const {
    f[0] = -k * atan(q[0]);
  }
  template <class S>
  void potential_hessian(const Vector<S, 1>& q, Matrix<S, 1>& out) const {
    out[0][0] = k / (1 + q[0] * q[0]);
  }
};
using Well = ContinuousGalerkin<FlatWell, A>;

PhasePoint<A, 1> at(double q, double p) {
  PhasePoint<A, 1> z;
  z.store({q}, {p});
  return z;
}

TEST(Newton, StartsFromTheExplicitPredictorWhereTheExtrapolatedGuessFails) {
  // The memory of a motion under far larger forces, and few iterations to get back from it.
  const FlatWell strong{1e6};
  const FlatWell weak{100};
  Well method(weak, {.quadrature = 5, .max_iterations = 3});
  auto far = at(-1e9, 0);
  for (int i = 0; i < 3; ++i) ASSERT_EQ(method.step(strong, 0.05, far), Outcome::done);
  auto z = at(1.5, 0);
  auto fresh = z;
  Well other(weak, {.quadrature = 5, .max_iterations = 3});
  ASSERT_EQ(other.step(weak, 0.05, fresh), Outcome::done);
  ASSERT_EQ(method.step(weak, 0.05, z), Outcome::done) << method.failure(weak, 0.05, z);
  EXPECT_EQ(method.newton().solved_from(Guess::predicted), 1);
  EXPECT_EQ(z.q[0].high, fresh.q[0].high) << "the same iteration from the same start";
}

TEST(Newton, StartsFromTheLastStateWhereThePredictorFails) {
  const auto problem = stiff_problem<Plane>(1e6);
  ContinuousGalerkin<Plane, A> method(problem, {.quadrature = 5});
  auto z = stiff_start(1e6, false);
  ASSERT_EQ(method.step(problem, 0.1, z), Outcome::done);
  EXPECT_EQ(method.newton().solved_from(Guess::last_state), 1);
}

TEST(Newton, DampsWhereUndampedItDiverges) {
  const FlatWell problem{100};
  Well method(problem, {.quadrature = 5});
  auto z = at(5, 0);
  const double initial = energy(problem, z.positions(), z.momenta());
  ASSERT_EQ(method.step(problem, 10, z), Outcome::done) << method.failure(problem, 10, z);
  EXPECT_EQ(method.newton().solved_from(Guess::damped), 1);
  // Five points on a segment of 2 x 5, whose nearest singularities are +-i: rho = 0.2 + sqrt(1.04).
  const double quadrature = 64.0 / 15 * std::pow(0.2 + std::sqrt(1.04), -10);
  EXPECT_NEAR(energy(problem, z.positions(), z.momenta()), initial, quadrature * initial);
}

TEST(Newton, AFailureReportsEveryAttempt) {
  const FlatWell problem{100};
  Well method(problem, {.quadrature = 5, .max_iterations = 2});
  auto z = at(5, 0);
  ASSERT_EQ(method.step(problem, 10, z), Outcome::not_converged);
  const std::string text = method.failure(problem, 10, z);
  for (const char* part : {"Newton did not converge in 2 iterations with 5 Gauss points from any of 3 starts",
                           "from the explicit predictor", "from the last state", "damped from the last state"}) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  }
  EXPECT_EQ(text.find("extrapolated"), std::string::npos) << "there was nothing to extrapolate from";
}

TEST(Newton, TheSeedsCriterionRefusesASolutionInsteadOfLookingForAnother) {
  const auto problem = stiff_problem<Plane>(1e6);
  ContinuousGalerkin<Plane, A> method(problem, {.quadrature = 5, .tolerance = 1e-13, .seed_criterion = true});
  auto z = stiff_start(1e6, false);
  Outcome outcome = Outcome::done;
  for (int i = 0; i < stiff_steps && outcome == Outcome::done; ++i) outcome = method.step(problem, 0.001, z);
  ASSERT_EQ(outcome, Outcome::not_converged);
  const std::string text = method.failure(problem, 0.001, z);
  EXPECT_NE(text.find("at rounding level, above the tolerance"), std::string::npos) << text;
  EXPECT_EQ(text.find("last state"), std::string::npos) << text;
}

TEST(Newton, WhatItRemembersInDoubtIsArchived) {
  const auto problem = stiff_problem<Polar>(1e3);
  const auto start = stiff_start(1e3, true);
  const auto make = [&] { return simulate(problem, Cg{{.quadrature = 6}}, start.positions(), start.momenta(), 0.1); };
  auto whole = make();
  ASSERT_EQ(whole.advance(21), Outcome::done);
  const auto saved = whole.save();
  ASSERT_EQ(whole.advance(40), Outcome::done);
  auto resumed = make();
  resumed.restore(saved);
  EXPECT_EQ(resumed.save(), saved);
  ASSERT_EQ(resumed.advance(40), Outcome::done);
  EXPECT_EQ(resumed.save(), whole.save());
}

TEST(Newton, TrustsExtrapolationAgain) {
  // A step in doubt, then a motion that steps resolve: a few starts from the last state, and no more.
  const FlatWell problem{1};
  Well method(problem, {.quadrature = 5});
  auto z = at(0.5, 0);
  for (int i = 0; i < 3; ++i) ASSERT_EQ(method.step(problem, 0.05, z), Outcome::done);
  auto jumped = at(-2, 30);
  ASSERT_EQ(method.step(problem, 5, jumped), Outcome::done);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(method.step(problem, 0.05, z), Outcome::done);
  EXPECT_GE(method.newton().solved_from(Guess::last_state), 3);
  EXPECT_LE(method.newton().solved_from(Guess::last_state), 8);
}

TEST(Equations, AnotherMethodIsItsEquations) { mutants::expect_sound(mutants::examine(mutants::Gauss{})); }

TEST(Equations, AWrongStageIsCaught) {
  // a_11 = 1/4 + 1/100: neither symplectic nor of order 4. The Jacobian is that of 4 n unknowns.
  mutants::expect_caught(mutants::examine(mutants::Gauss{{.shift = 0.01}}), "symplectic");
}

TEST(Equations, AnotherMethodIsSavedAndAllocatesNothing) {
  const HenonHeiles<double> problem;
  const auto make = [&] { return simulate(problem, mutants::Gauss{}, {0.3, -0.15}, {0.2, 0.25}, 0.2); };
  auto whole = make();
  ASSERT_EQ(whole.advance(50), Outcome::done);
  const auto saved = whole.save();
  const long long before = test::allocations();
  ASSERT_EQ(whole.advance(50), Outcome::done);
  if (test::counts_allocations()) {
    EXPECT_LE(test::allocations() - before, 0);
  }
  auto resumed = make();
  resumed.restore(saved);
  ASSERT_EQ(resumed.advance(50), Outcome::done);
  EXPECT_EQ(resumed.save(), whole.save());
}

}  // namespace
}  // namespace hamflow
