// dop853 and taylor as methods: the tolerance that is asked for is met, orders, memory, refusals, other arithmetics.
#include <functional>
#include <string>

#include "../support/near.hpp"
#include "engine/reference_flow.hpp"
#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/detail/problems/gravity.hpp"
#include "hamflow/detail/run/any_problem.hpp"
#include "hamflow/methods/dop853.hpp"
#include "hamflow/methods/taylor.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_relative.hpp"
#include "hamflow/problems/duffing.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/problems/lennard_jones_oscillator.hpp"
#include "hamflow/problems/of_any_size/fput.hpp"
#include "hamflow/problems/pendulum.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/problems/potentials/power.hpp"
#include "hamflow/problems/support/from_functions.hpp"
#include "hamflow/problems/support/polar.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace hamflow {

namespace {

using L = long double;
using KeplerProblem = CentralForce<double, Kepler>;

template <class P, class A>
using Point = PhasePoint<A, P::dimension>;

template <class P, class Recipe, class A = Plain<typename P::Real>>
Point<P, A> after(const P& problem, const Recipe& recipe, const VectorOf<P>& q, const VectorOf<P>& p,
                  typename P::Real h, int steps = 1) {
  auto method = recipe.template bind<P, A>(problem);
  Point<P, A> z;
  z.store(q, p);
  for (int i = 0; i < steps; ++i) EXPECT_EQ(method.step(problem, h, z), Outcome::done);
  return z;
}

/// The max-norm distance to the flow by extrapolation.
template <class P, class A>
L distance_to_flow(const P& problem, const Point<P, A>& z, const VectorOf<P>& q, const VectorOf<P>& p,
                   typename P::Real time) {
  constexpr std::size_t width = P::dimension == dynamic ? dynamic : 2 * P::dimension;
  auto start = zeros<typename P::Real, width>(2 * q.size());
  for (std::size_t i = 0; i < q.size(); ++i) {
    start[i] = q[i];
    start[q.size() + i] = p[i];
  }
  const auto exact = reference_flow(problem, start, time);
  L most = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    most = std::max(most, std::fabs(L(z.q[i]) - L(exact[i])));
    most = std::max(most, std::fabs(L(z.p[i]) - L(exact[q.size() + i])));
  }
  return most;
}

// Three periods with e = 0.6 in 40 to 130 sub-steps a period, each wrong by at most a tolerance times the size of q and
// of p. An error in the energy by delta shifts the phase by 3 pi delta/|E| in each period that is left, and the fastest
// motion, |q'| = 2 and |p'| = 6, turns phases into distances: 6 * 3 * 3 pi * 100 * tolerance = 1.7e4 tolerance at most,
// were all errors of one sign; they are a tenth to a hundredth of that.
template <class Recipe>
void expect_kepler_meets(double tolerance, double factor) {
  const KeplerProblem problem(1.0, Kepler<double>(1.0));
  const double time = 3 * 2 * pi_value<double>();
  const auto z = after<KeplerProblem, Recipe, Compensated<double>>(problem, Recipe{{.tolerance = tolerance}}, {0.4, 0},
                                                                   {0, 2}, time);
  const auto exact = kepler_flow<L>(1, 1, {0.4L, 0}, {0, 2}, L(time));
  const L error = std::hypot(L(z.q[0].high) - exact.q[0], L(z.q[1].high) - exact.q[1]);
  EXPECT_LE(error, factor * tolerance) << "tolerance " << tolerance;
  EXPECT_GE(error, tolerance / 1000) << "far more work than was asked for, tolerance " << tolerance;
}
TEST(Adaptive, dop853_meets_tolerances_on_kepler) {
  for (const double t : {1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13}) expect_kepler_meets<Dop853>(t, 500);
}
TEST(Adaptive, taylor_meets_tolerances_on_kepler) {
  for (const double t : {1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13}) expect_kepler_meets<Taylor>(t, 50);
}

/// Both methods against extrapolation, with a tolerance of 1e-14 in long double.
template <class P>
void expect_both_follow(const P& problem, const VectorOf<P>& q, const VectorOf<P>& p, L time, L allowed,
                        const std::string& name) {
  using A = Plain<L>;
  const AdaptiveOptions options{.tolerance = 1e-14};
  EXPECT_LE((distance_to_flow<P, A>(problem, after(problem, Dop853{options}, q, p, time), q, p, time)), allowed)
      << "dop853, " << name;
  EXPECT_LE((distance_to_flow<P, A>(problem, after(problem, Taylor{options}, q, p, time), q, p, time)), allowed)
      << "taylor, " << name;
}
// 1e-12: a hundred tolerances, for some ten sub-steps and the stretch of neighbouring orbits.
TEST(Adaptive, both_follow_problems_of_every_kind) {
  expect_both_follow(CentralForce<L, Kepler>(1, Kepler<L>(1)), {0.4L, 0}, {0, 2}, 3, 1e-12L, "kepler");
  expect_both_follow(HenonHeiles<L>(), {0.1L, 0.2L}, {0.4L, 0.15L}, 7, 1e-12L, "henon-heiles");
  expect_both_follow(Pendulum<L>(), {0}, {1.9L}, 7, 1e-12L, "pendulum through q = 0");
  expect_both_follow(Duffing<L>(), {0}, {0.5L}, 7, 1e-12L, "duffing");
  expect_both_follow(LennardJonesOscillator<L>(), {1.5L}, {0}, 4, 1e-12L, "lennard-jones at rest");
  expect_both_follow(DoublePendulumNonlinearAbsolute<L>(), {0.5L, -0.3L}, {1, 0.4L}, 2, 1e-12L, "double pendulum");
  expect_both_follow(DoublePendulumNonlinearRelative<L>(), {0.5L, -0.3L}, {0, 0}, 2, 1e-12L, "relative angles");
  expect_both_follow(PolarCentralForce<L, Kepler>(1, Kepler<L>(1)), {0.4L, 0}, {0, 0.8L}, 3, 1e-12L, "polar");
  expect_both_follow(PolarCentralForce<L, Kepler>(1, Kepler<L>(-1)), {0.4L, 0}, {0, 0}, 1, 1e-12L, "p_phi = 0");
  expect_both_follow(CentralForce<L, Power>(1, Power<L>({0.7L, 0.2L}, {1.3L, 3})), {1, 0}, {0, 0.6L}, 3, 1e-12L,
                     "real exponents");
  expect_both_follow(Fput<L>(4, 0.25L, 0.5L), {0.1L, 0.4L, -0.2L, 0.3L}, {0, 0, 0.5L, 0}, 3, 1e-12L, "fput");
  expect_both_follow(Gravity<L>({1, 0.5L, 0.2L}, 1, 0.1L, 3), {1, 0, 0, -1, 0, 0.1L, 0, 2, 0},
                     {0, 0.3L, 0, 0, -0.3L, 0, 0.1L, 0, 0}, 3, 1e-12L, "n-body");
}

// Functions of the user, whose gradients are dual numbers over traces.
TEST(Adaptive, taylor_differentiates_functions_of_the_user) {
  const auto quartic = separable<2>([](const auto& p) { return (p[0] * p[0] + p[1] * p[1]) / 2; },
                                    [](const auto& q) { return exp(q[0] * q[1]) + pow(q[0], 4.0) + cosh(q[1]); });
  const auto whole = hamiltonian<1>([](const auto& q, const auto& p) {
    return sqrt(1.0 + p[0] * p[0]) * (2.0 + sin(q[0])) + tanh(q[0]) / 2 + atan(q[0] * p[0]);
  });
  const AdaptiveOptions options{.tolerance = 1e-14};
  const Vector<double, 2> q{0.3, 0.2}, p{0.1, 0.4};
  EXPECT_LE((distance_to_flow<decltype(quartic), Plain<double>>(quartic, after(quartic, Taylor{options}, q, p, 2.0), q,
                                                                p, 2.0)),
            1e-13L);
  const Vector<double, 1> x{0.3}, y{0.7};
  EXPECT_LE(
      (distance_to_flow<decltype(whole), Plain<double>>(whole, after(whole, Taylor{options}, x, y, 2.0), x, y, 2.0)),
      1e-13L);
}

/// However a time is divided into steps, the end is the same to a few tolerances: here a period, so that there is no
/// drift of the phase to tell orbits apart but that of their own errors.
template <class Recipe>
void expect_the_same_however_divided() {
  const KeplerProblem problem(1.0, Kepler<double>(1.0));
  const Recipe recipe{{.tolerance = 1e-11}};
  const double time = 2 * pi_value<double>();
  const auto whole = after(problem, recipe, {0.4, 0}, {0, 2}, time);
  for (const int steps : {2, 7, 100, 1000}) {
    const auto parts = after(problem, recipe, {0.4, 0}, {0, 2}, time / steps, steps);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LE(std::fabs(parts.q[i] - whole.q[i]), 100e-11) << steps;
      EXPECT_LE(std::fabs(parts.p[i] - whole.p[i]), 200e-11) << steps;
    }
  }
}
TEST(Adaptive, the_spacing_of_steps_does_not_matter) {
  expect_the_same_however_divided<Dop853>();
  expect_the_same_however_divided<Taylor>();
}

template <class P>
double taylor_slope(const P& problem, int order, const VectorOf<P>& q, const VectorOf<P>& p, L time, int steps) {
  std::vector<L> errors;
  for (int halving = 0; halving < 5; ++halving, steps *= 2) {
    const auto z = after(problem, Taylor{{.order = order, .fixed = true}}, q, p, time / steps, steps);
    errors.push_back(distance_to_flow<P, Plain<L>>(problem, z, q, p, time));
  }
  return static_cast<double>(std::log2(errors.front() / errors.back()) / 4);
}
TEST(Adaptive, fixed_taylor_has_the_order_asked_for) {
  const HenonHeiles<L> problem;
  EXPECT_NEAR(taylor_slope(problem, 1, {0.1L, 0.2L}, {0.4L, 0.15L}, 2.3L, 400), 1, 0.1);
  EXPECT_NEAR(taylor_slope(problem, 6, {0.1L, 0.2L}, {0.4L, 0.15L}, 3.7L, 10), 6, 0.3);
  EXPECT_NEAR(taylor_slope(problem, 12, {0.1L, 0.2L}, {0.4L, 0.15L}, 3.7L, 3), 12, 0.8);
  EXPECT_NEAR(taylor_slope(DoublePendulumNonlinearAbsolute<L>(), 6, {0.5L, -0.3L}, {1, 0.4L}, 1.3L, 320), 6, 0.3);
  EXPECT_EQ((TaylorMethod<HenonHeiles<L>, Plain<L>>::cheapest_order(1e-12)), 15);  // ceil(13.8 + 1)
}

TEST(Adaptive, a_block_at_rest_or_at_zero_does_not_stop_the_motion) {
  const HenonHeiles<double> problem;
  auto taylor = Taylor{}.bind<HenonHeiles<double>, Plain<double>>(problem);
  auto dop853 = Dop853{}.bind<HenonHeiles<double>, Plain<double>>(problem);
  PhasePoint<Plain<double>, 2> z;
  z.store({0, 0}, {0, 0});
  EXPECT_EQ(taylor.step(problem, 10, z), Outcome::done);
  EXPECT_EQ(dop853.step(problem, 10, z), Outcome::done);
  EXPECT_EQ(z.q, (Vector<double, 2>{0, 0}));
  EXPECT_EQ(taylor.substeps() + dop853.substeps(), 2);
  // From q = 0 and from p = 0 as from elsewhere: a quarter of a small oscillation, 2 to 12 sub-steps.
  for (const bool at_rest : {false, true}) {
    z.store({at_rest ? 0.1 : 0, 0}, {at_rest ? 0 : 0.1, 0});
    const long long before = taylor.substeps();
    dop853.invalidate();
    const long long before8 = dop853.substeps() + dop853.rejected();
    PhasePoint<Plain<double>, 2> z8 = z;
    EXPECT_EQ(taylor.step(problem, 1.57, z), Outcome::done);
    EXPECT_EQ(dop853.step(problem, 1.57, z8), Outcome::done);
    EXPECT_LE(taylor.substeps() - before, 4);
    EXPECT_LE(dop853.substeps() + dop853.rejected() - before8, 24);
  }
}

template <class Recipe>
void expect_refused_at_collision() {
  const KeplerProblem problem(1.0, Kepler<double>(1.0));
  auto method = Recipe{}.template bind<KeplerProblem, Plain<double>>(problem);
  PhasePoint<Plain<double>, 2> z;
  z.store({1, 0}, {0, 0});  // falls into the centre at t = pi/sqrt(8) = 1.11
  const auto start = z;
  EXPECT_EQ(method.step(problem, 2, z), Outcome::not_converged);
  EXPECT_EQ(z.q, start.q);
  EXPECT_EQ(z.p, start.p);
  const std::string why = method.failure(problem, 2, z);
  EXPECT_NE(why.find("collision"), std::string::npos) << why;
  EXPECT_EQ(method.step(problem, 1, z), Outcome::done) << "until shortly before";

  auto impatient = Recipe{{.max_substeps = 3}}.template bind<KeplerProblem, Plain<double>>(problem);
  z.store({0.4, 0}, {0, 2});
  EXPECT_EQ(impatient.step(problem, 6, z), Outcome::not_converged);
  EXPECT_NE(impatient.failure(problem, 6, z).find("3 sub-steps"), std::string::npos);
}
TEST(Adaptive, collisions_are_told) {
  expect_refused_at_collision<Dop853>();
  expect_refused_at_collision<Taylor>();
}

TEST(Adaptive, taylor_refuses_branches_before_anything_runs) {
  const auto bouncing =
      separable<1>([](const auto& p) { return p[0] * p[0] / 2; }, [](const auto& q) { return abs(q[0]); });
  using P = decltype(bouncing);
  static_assert(Taylor::accepts<P> && Dop853::accepts<P>);
  const std::string message = test::message_of<Error>([&] { (void)Taylor{}.bind<P, Plain<double>>(bouncing); });
  EXPECT_NE(message.find("branches that depend on the state"), std::string::npos) << message;
}

/// Polar coordinates ask whether p_phi = 0: the tape of one answer is not used for the other.
TEST(Adaptive, taylor_records_anew_on_the_other_side_of_an_equality) {
  using P = PolarCentralForce<L, Kepler>;
  using A = Plain<L>;
  const P problem(1, Kepler<L>(-1));
  auto method = Taylor{}.bind<P, A>(problem);
  for (const L turn : {0.0L, 0.8L, 0.0L}) {
    PhasePoint<A, 2> z;
    z.store({0.4L, 0}, {0, turn});
    EXPECT_EQ(method.step(problem, 1, z), Outcome::done);
    EXPECT_LE((distance_to_flow<P, A>(problem, z, {0.4L, 0}, {0, turn}, 1)), 1e-10L) << static_cast<double>(turn);
  }
}

template <class Recipe>
void expect_same_bits_however_advanced() {
  const KeplerProblem problem(1.0, Kepler<double>(1.0));
  auto at_once = simulate(problem, Recipe{}, {0.4, 0}, {0, 2}, 0.7);
  auto one_by_one = simulate(problem, Recipe{}, {0.4, 0}, {0, 2}, 0.7);
  EXPECT_EQ(at_once.advance(40), Outcome::done);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(one_by_one.advance(1), Outcome::done);
  EXPECT_EQ(at_once.bits(), one_by_one.bits());
  // What is restored goes on as what was saved.
  auto restored = simulate(problem, Recipe{}, {0.4, 0}, {0, 2}, 0.7);
  restored.restore(at_once.save());
  EXPECT_EQ(at_once.advance(10), Outcome::done);
  EXPECT_EQ(restored.advance(10), Outcome::done);
  EXPECT_EQ(at_once.save(), restored.save());
}
TEST(Adaptive, memory_belongs_to_the_run) {
  expect_same_bits_however_advanced<Dop853>();
  expect_same_bits_however_advanced<Taylor>();
}

/// S Psi_-h S = Psi_h, bit for bit, from a fresh start.
template <class Recipe>
void expect_weakly_reversible(bool fixed) {
  const DoublePendulumNonlinearAbsolute<double> problem;
  const Recipe recipe{{.fixed = fixed}};
  const auto forth = after(problem, recipe, {0.5, -0.3}, {1.0, 0.4}, 0.3);
  const auto back = after(problem, recipe, {0.5, -0.3}, {-1.0, -0.4}, -0.3);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(forth.q[i], back.q[i]);
    EXPECT_EQ(forth.p[i], -back.p[i]);
  }
}
TEST(Adaptive, both_are_weakly_reversible) {
  for (const bool fixed : {false, true}) {
    expect_weakly_reversible<Dop853>(fixed);
    expect_weakly_reversible<Taylor>(fixed);
  }
}

TEST(Adaptive, no_derivative_is_computed_twice) {
  const KeplerProblem problem(1.0, Kepler<double>(1.0));
  auto method = Dop853{}.bind<KeplerProblem, Plain<double>>(problem);
  PhasePoint<Plain<double>, 2> z;
  z.store({0.4, 0}, {0, 2});
  for (int i = 0; i < 20; ++i) EXPECT_EQ(method.step(problem, 1.3, z), Outcome::done);
  EXPECT_GT(method.rejected(), 0);
  EXPECT_EQ(method.effort().force, 12 * method.substeps() + 11 * method.rejected());
}

/// The Jacobian of a step by dual numbers through it: symplectic to the error of the step.
template <class Recipe>
void expect_dual_numbers_pass(bool fixed) {
  using D = Dual<double, 1>;
  const DoublePendulumNonlinearAbsolute<double> problem;
  using P = DoublePendulumNonlinearAbsolute<double>;
  double jacobian[4][4];
  for (std::size_t k = 0; k < 4; ++k) {
    auto method = Recipe{{.fixed = fixed}}.template bind<P, Plain<D>>(problem);
    PhasePoint<Plain<D>, 2> z;
    z.store({D(0.5), D(-0.3)}, {D(1.0), D(0.4)});
    (k < 2 ? z.q[k] : z.p[k - 2]).slope[0] = 1;
    EXPECT_EQ(method.step(problem, 0.01, z), Outcome::done);
    for (std::size_t i = 0; i < 4; ++i) jacobian[i][k] = (i < 2 ? z.q[i] : z.p[i - 2]).slope[0];
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      double form = 0;  // column i against column k
      for (std::size_t j = 0; j < 2; ++j) {
        form += jacobian[j][i] * jacobian[j + 2][k] - jacobian[j + 2][i] * jacobian[j][k];
      }
      const double expected = k == i + 2 ? 1 : i == k + 2 ? -1 : 0;
      EXPECT_NEAR(form, expected, 64 * test::epsilon) << i << k;
    }
  }
}
TEST(Adaptive, dual_numbers_pass_through_a_step) {
  for (const bool fixed : {false, true}) {
    expect_dual_numbers_pass<Dop853>(fixed);
    expect_dual_numbers_pass<Taylor>(fixed);
  }
}

/// Kepler, e = 0.6, to the eccentric anomaly E = 5, three quarters of a period: t = E - e sin E,
/// q = (cos E - e, sqrt(1 - e^2) sin E), in any arithmetic.
template <class R, class Recipe>
void expect_digits_on_kepler(const Recipe& recipe, double factor) {
  using P = CentralForce<R, Kepler>;
  const P problem(R(1), Kepler<R>(R(1)));
  const R e = R(3) / R(5);
  const R sine = sin(R(5));
  const auto z = after(problem, recipe, {R(1) - e, R(0)}, {R(0), R(2)}, R(5) - e * sine);
  const R error = larger(R(abs(z.q[0] - (cos(R(5)) - e))), R(abs(z.q[1] - R(4) / R(5) * sine)));
  EXPECT_LE(static_cast<double>(error), factor * recipe.options.tolerance);
  EXPECT_GE(static_cast<double>(error), recipe.options.tolerance / 1000);
}
// A tenth of the phase error of three periods, see above.
TEST(Adaptive, more_digits_are_used) {
  expect_digits_on_kepler<Quad>(Dop853{{.tolerance = 1e-26}}, 50);
  expect_digits_on_kepler<Quad>(Taylor{{.tolerance = 1e-30}}, 50);
  expect_digits_on_kepler<DoubleDouble>(Taylor{{.tolerance = 1e-28}}, 50);
  const MpDigits scope(60);
  expect_digits_on_kepler<Mp>(Taylor{{.tolerance = 1e-55}}, 50);
}

/// Behind virtual calls (detail/run/any_problem.hpp) the same bits, and dual numbers pass there, too.
template <class P, class Recipe>
void expect_same_behind_virtual_calls(const P& problem, const Recipe& recipe) {
  using Any = AnyProblem<double, capabilities_of<P>(), Trace<double>, Dual<double, 1>>;
  const auto typed = after(problem, recipe, {0.5, -0.3}, {1.0, 0.4}, 0.5);
  const auto erased = after(Any::of(problem), recipe, {0.5, -0.3}, {1.0, 0.4}, 0.5);
  using A = Plain<Dual<double, 1>>;
  PhasePoint<A, dynamic> dual;
  dual.store({0.5, -0.3}, {1.0, 0.4});
  const Any any = Any::of(problem);
  auto method = recipe.template bind<Any, A>(any);
  EXPECT_EQ(method.step(any, 0.5, dual), Outcome::done);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(typed.q[i], erased.q[i]);
    EXPECT_EQ(typed.p[i], erased.p[i]);
    EXPECT_EQ(typed.q[i], dual.q[i].value);
    EXPECT_EQ(typed.p[i], dual.p[i].value);
  }
}
TEST(Adaptive, types_do_not_change_bits) {
  expect_same_behind_virtual_calls(HenonHeiles<double>(), Dop853{});
  expect_same_behind_virtual_calls(HenonHeiles<double>(), Taylor{});
  expect_same_behind_virtual_calls(DoublePendulumNonlinearAbsolute<double>(), Dop853{});
  expect_same_behind_virtual_calls(DoublePendulumNonlinearAbsolute<double>(), Taylor{});
}

TEST(Adaptive, doubles_are_read_exactly_in_other_numbers) {
  using D = Dual<double, 1>;
  for (const double x : {0.0, 1.0, 0.1, 0x1.fffffffffffffp-3, 0x1p-50, 3e17, 1.0 / 3}) {
    EXPECT_EQ(exact_number<D>(x).value, x) << x;
    EXPECT_EQ(static_cast<double>(exact_number<Quad>(x)), x) << x;
  }
}

}  // namespace
}  // namespace hamflow
