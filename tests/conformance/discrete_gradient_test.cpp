// discrete-gradient and itoh-abe: their definitions solved by another iteration in twice the digits, the energy, and
// increments that vanish.
#include "../support/near.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/methods/gonzalez.hpp"
#include "hamflow/methods/itoh_abe.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/problems/pendulum.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/problems/support/from_functions.hpp"
#include "mutants/examine.hpp"

namespace hamflow {

namespace mutants {
/// A mutant: Gonzalez without its correction is the midpoint rule.
template <class P, class R>
struct WithoutCorrection : MidpointDiscreteGradient<P, R> {
  using Base = MidpointDiscreteGradient<P, R>;
  using Base::Base;
  template <class S>
  Vector<S, dynamic> at(const P& problem, const Vector<S, dynamic>& z0, const Vector<S, dynamic>& u) const {
    return Base::gradient_at(problem, Base::on_the_way(z0, u, R(0.5)));
  }
  void linearise(const P& problem, const Vector<R, dynamic>& z0, const Vector<R, dynamic>& u, bool wanted,
                 LinearisedGradient<R>& out, Effort& effort) const {
    Base::linearise(problem, z0, u, wanted, out, effort);
    out.value = at(problem, z0, u);
    out.by_u = Base::hessian_at(problem, Base::on_the_way(z0, u, R(0.5)));
    for (std::size_t i = 0; i < u.size(); ++i) {
      for (std::size_t j = 0; j < u.size(); ++j) out.by_u[i][j] /= R(2);
    }
  }
};
struct Uncorrected {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  template <class P>
  static constexpr bool accepts = Smooth<P>;
  NewtonOptions options{};
  template <class P, class A>
  using Stepper = ImplicitMethod<P, A, DiscreteGradientStep<P, typename A::Real, WithoutCorrection>>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, options);
  }
};
}  // namespace mutants

namespace {

static_assert(StepEquations<DiscreteGradientStep<HenonHeiles<double>, double, MidpointDiscreteGradient>>);
static_assert(StepEquations<DiscreteGradientStep<HenonHeiles<double>, double, CoordinateIncrements>>);

template <class R>
using Z = std::vector<R>;

template <class P, class R>
R energy_at(const P& problem, const Z<R>& z) {
  Vector<R, 2> q{z[0], z[1]};
  Vector<R, 2> p{z[2], z[3]};
  return energy(problem, q, p);
}
/// DH of Gonzalez as it is written.
template <class P, class R>
Z<R> by_gonzalez(const P& problem, const Z<R>& z0, const Z<R>& u) {
  Z<R> z1 = z0;
  Vector<R, 2> q, p, dq, dp;
  for (std::size_t i = 0; i < 4; ++i) {
    z1[i] += u[i];
    (i < 2 ? q[i] : p[i - 2]) = z0[i] + u[i] / R(2);
  }
  gradient(problem, q, p, dq, dp);
  Z<R> dh{dq[0], dq[1], dp[0], dp[1]};
  R along(0);
  R square(0);
  for (std::size_t i = 0; i < 4; ++i) {
    along += dh[i] * u[i];
    square += u[i] * u[i];
  }
  const R c = (energy_at(problem, z1) - energy_at(problem, z0) - along) / square;
  for (std::size_t i = 0; i < 4; ++i) dh[i] += c * u[i];
  return dh;
}
/// DH of Itoh and Abe as it is written.
template <class P, class R>
Z<R> by_coordinates(const P& problem, const Z<R>& z0, const Z<R>& u) {
  Z<R> z = z0;
  Z<R> dh;
  for (std::size_t i = 0; i < 4; ++i) {
    const R before = energy_at(problem, z);
    z[i] += u[i];
    dh.push_back((energy_at(problem, z) - before) / u[i]);
  }
  return dh;
}
/// u = h J DH by fixed-point iteration with half of each change, without a first guess that is any good.
template <class P, class R, class DH>
Z<R> solved(const P& problem, const Z<R>& z0, const R& h, const DH& dh) {
  Z<R> u(4, h);
  for (int k = 0; k < 400; ++k) {
    const Z<R> d = dh(problem, z0, u);
    const Z<R> next{h * d[2], h * d[3], -h * d[0], -h * d[1]};
    for (std::size_t i = 0; i < 4; ++i) u[i] = (u[i] + next[i]) / R(2);
  }
  for (std::size_t i = 0; i < 4; ++i) u[i] += z0[i];
  return u;
}

/// The same number.
template <class R>
Mp as_mp(const R& x) {
  if constexpr (std::is_same_v<R, Mp>) {
    return x;
  } else {
    Mp sum(0);
    R rest = x;
    for (int part = 0; part < 3; ++part) {
      sum += Mp(static_cast<double>(rest));
      rest = rest - R(static_cast<double>(rest));
    }
    return sum;
  }
}

// Not q2 = -1/2, where the force on q1 vanishes and the quotient as it is written is 0/0.
constexpr double start[4] = {0.7, -0.25, 0.5, 0.6};

/// One step of a recipe in R against the definition in mp(80).
template <template <class> class Family, class R, class Recipe, class DH>
void expect_defined(const Recipe& recipe, const DH& dh, double bound) {
  const Family<R> problem{};
  auto simulation = simulate(problem, recipe, Vector<R, 2>{R(start[0]), R(start[1])},
                             Vector<R, 2>{R(start[2]), R(start[3])}, R(0.03125));
  ASSERT_EQ(simulation.advance(1), Outcome::done) << simulation.failure();
  const Vector<R, 2> q = simulation.state().positions();
  const Vector<R, 2> p = simulation.state().momenta();
  const MpDigits scope(80);
  const Family<Mp> fine{};
  const Z<Mp> exact = solved(fine, Z<Mp>{Mp(start[0]), Mp(start[1]), Mp(start[2]), Mp(start[3])}, Mp(0.03125), dh);
  const R found[4] = {q[0], q[1], p[0], p[1]};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LE(std::fabs(static_cast<double>(as_mp(found[i]) - exact[i])), bound) << i;
  }
}
template <template <class> class Family, class Recipe, class DH>
void expect_defined_in_all(const Recipe& recipe, const DH& dh) {
  // Terms of a step: some ten roundings of numbers of size 1, 30 for the double pendulum's forces times h.
  expect_defined<Family, double>(recipe, dh, 32 * test::epsilon);
  expect_defined<Family, Quad>(recipe, dh, 32 * 1.93e-34);
  const MpDigits scope(40);
  expect_defined<Family, Mp>(recipe, dh, 1e-38);
}

TEST(DiscreteGradient, IsItsDefinition) {
  const auto dh = [](const auto& problem, const auto& z0, const auto& u) { return by_gonzalez(problem, z0, u); };
  expect_defined_in_all<HenonHeiles>(DiscreteGradient{}, dh);
  expect_defined_in_all<DoublePendulumNonlinearAbsolute>(DiscreteGradient{}, dh);
}
TEST(ItohAbe, IsItsDefinition) {
  const auto dh = [](const auto& problem, const auto& z0, const auto& u) { return by_coordinates(problem, z0, u); };
  expect_defined_in_all<HenonHeiles>(ItohAbe{}, dh);
  expect_defined_in_all<DoublePendulumNonlinearAbsolute>(ItohAbe{}, dh);
}

/// The largest energy error of a run in units of `rounding` times sqrt(steps): roundings of the terms of a step add up
/// as a walk.
template <class P, class Recipe, class V>
double walked(const P& problem, const Recipe& recipe, const V& q, const V& p, double h, int steps) {
  auto simulation = simulate(problem, recipe, q, p, h);
  EXPECT_EQ(simulation.advance(steps), Outcome::done) << simulation.failure();
  EXPECT_LE(simulation.effort().solves_max, 5);
  return simulation.energy().max_error / (test::epsilon * std::sqrt(steps) * simulation.energy_scale());
}
template <class Recipe>
void expect_energy(const Recipe& recipe) {
  // Of each step: work of |u| |grad H| epsilon times some ten terms; here |u| |grad H| < scale/10.
  EXPECT_LE(
      walked(HenonHeiles<double>{}, recipe, Vector<double, 2>{0.3, -0.15}, Vector<double, 2>{0.2, 0.25}, 0.2, 10000),
      1);
  EXPECT_LE(walked(Pendulum<double>{}, recipe, Vector<double, 1>{1.5}, Vector<double, 1>{0.3}, 0.1, 10000), 1);
  EXPECT_LE(walked(DoublePendulumNonlinearAbsolute<double>{}, recipe, Vector<double, 2>{0.7, -0.5},
                   Vector<double, 2>{1.5, 0.6}, 0.01, 10000),
            1);
  EXPECT_LE(walked(CentralForce<double, Kepler>(1.0, Kepler<double>(1.0)), recipe, Vector<double, 2>{0.4, 0.0},
                   Vector<double, 2>{0.0, 2.0}, 0.05, 10000),
            1);
}
TEST(DiscreteGradient, KeepsTheEnergyToRounding) { expect_energy(DiscreteGradient{}); }
TEST(ItohAbe, KeepsTheEnergyToRounding) { expect_energy(ItohAbe{}); }

/// Oscillations of amplitude a about the lowest point, H = -9.81 there: in units of a they are those of the linear
/// pendulum, whatever a is. With energies subtracted a = 1e-9 would be noise.
template <class Recipe>
void expect_small_motion(const Recipe& recipe) {
  for (const double a : {1e-5, 1e-9, 1e-14, 1e-100}) {
    const Pendulum<double> problem;
    auto simulation = simulate(problem, recipe, Vector<double, 1>{a}, Vector<double, 1>{0.0}, 0.1);
    ASSERT_EQ(simulation.advance(50), Outcome::done) << simulation.failure();
    Matrix<double, 1> qq, qp, pp;
    hessian(problem, Vector<double, 1>{0.0}, Vector<double, 1>{0.0}, qq, qp, pp);
    // H = (qq q^2 + pp p^2)/2: both methods are the midpoint rule there, a rotation by 2 arctan(h omega/2) a step.
    const double omega = std::sqrt(qq[0][0] * pp[0][0]);
    const double angle = 50 * 2 * std::atan(0.1 * omega / 2);
    EXPECT_NEAR(simulation.state().q[0].high / a, std::cos(angle), a * a + 50 * 8 * test::epsilon) << a;
    EXPECT_LE(simulation.effort().solves_max, 3);
  }
}
TEST(DiscreteGradient, OfSmallMotionsIsThatOfTheLinearSystem) { expect_small_motion(DiscreteGradient{}); }
TEST(ItohAbe, OfSmallMotionsIsThatOfTheLinearSystem) { expect_small_motion(ItohAbe{}); }

/// A coordinate that does not move, and nothing that moves at all.
template <class Recipe>
void expect_rest(const Recipe& recipe) {
  const HenonHeiles<double> problem;
  auto still = simulate(problem, recipe, {0, 0}, {0, 0}, 0.2);
  ASSERT_EQ(still.advance(10), Outcome::done) << still.failure();
  EXPECT_EQ(still.state().positions(), (Vector<double, 2>{0, 0}));
  // q1 = p1 = 0 stays so.
  auto line = simulate(problem, recipe, {0, 0.3}, {0, 0.1}, 0.2);
  ASSERT_EQ(line.advance(1000), Outcome::done) << line.failure();
  EXPECT_EQ(line.state().positions()[0], 0);
  EXPECT_LE(line.energy().max_error, 64 * test::epsilon);
}
TEST(DiscreteGradient, AtRest) { expect_rest(DiscreteGradient{}); }
TEST(ItohAbe, AtRest) { expect_rest(ItohAbe{}); }

TEST(DiscreteGradient, TakesAnyH) {
  // Not separable, with a branch that a recording has to follow: |q|^3.
  const auto problem = hamiltonian<1>([](const auto& q, const auto& p) {
    const auto size = abs(q[0]);
    return p[0] * p[0] / 2.0 * (1.0 + q[0] * q[0]) + size * size * size;
  });
  for (const double h : {0.1, 0.3}) {
    auto simulation = simulate(problem, DiscreteGradient{}, {0.7}, {0.4}, h);
    ASSERT_EQ(simulation.advance(1000), Outcome::done) << simulation.failure();
    EXPECT_LE(simulation.energy().max_error, 64 * test::epsilon);
    auto other = simulate(problem, ItohAbe{}, {0.7}, {0.4}, h);
    ASSERT_EQ(other.advance(1000), Outcome::done) << other.failure();
    EXPECT_LE(other.energy().max_error, 64 * test::epsilon);
  }
}

// That both are what they claim to be is measured with the catalogue (claims_test.cpp).
TEST(DiscreteGradient, WithoutItsCorrectionIsCaught) {
  const StepMapOf<HenonHeiles, mutants::Uncorrected> map([]<class R>() { return HenonHeiles<R>(); },
                                                         mutants::Uncorrected{});
  EXPECT_EQ(measure_energy(map, region_of("henon-heiles")).conserving(map.claims().order), Conservation::no);
}

}  // namespace
}  // namespace hamflow
