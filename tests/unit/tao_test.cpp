// Steps in the doubled phase space: against their definition, and what binds and reverses the second copy.
#include "hamflow/methods/tao.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/run/simulation_of.hpp"

namespace hamflow {
namespace {

/// The example of Tao2016, sect. IV: H = (q^2 + 1)(p^2 + 1)/2, of one degree of freedom, not separable.
struct Quartic {
  using Real = double;
  static constexpr std::size_t dimension = 1;
  template <class S>
  S energy(const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    return (q[0] * q[0] + S(1)) * (p[0] * p[0] + S(1)) / S(2);
  }
};

constexpr double start_q = -3;
constexpr double start_p = 0.3;

struct Four {
  long double q, p, x, y;
};
long double by_q(long double q, long double p) { return q * (p * p + 1); }
long double by_p(long double q, long double p) { return (q * q + 1) * p; }

/// One tao2 step as the three flows are printed, with the matrix R of the third.
Four leap(Four z, long double h, long double omega) {
  const auto a = [&](long double d) {
    z.p -= d * by_q(z.q, z.y);
    z.x += d * by_p(z.q, z.y);
  };
  const auto b = [&](long double d) {
    z.q += d * by_p(z.x, z.p);
    z.y -= d * by_q(z.x, z.p);
  };
  a(h / 2);
  b(h / 2);
  const long double c = std::cos(2 * omega * h);
  const long double s = std::sin(2 * omega * h);
  const long double u = z.q - z.x;
  const long double v = z.p - z.y;
  z = {(z.q + z.x + c * u + s * v) / 2, (z.p + z.y - s * u + c * v) / 2, (z.q + z.x - c * u - s * v) / 2,
       (z.p + z.y + s * u - c * v) / 2};
  b(h / 2);
  a(h / 2);
  return z;
}

template <int order>
void expect_definition(double omega) {
  constexpr double h = 0.005;
  const long double jump = 1 / (2 - std::cbrt(2.0L));
  Four z{start_q, start_p, start_q, start_p};
  auto run = simulate(Quartic{}, Tao<order>{{.omega = omega}}, {start_q}, {start_p}, h);
  for (int step = 1; step <= 100; ++step) {
    if (order == 2) {
      z = leap(z, static_cast<long double>(h), omega);
    } else {
      for (const long double part : {jump, 1 - 2 * jump, jump}) z = leap(z, part * static_cast<long double>(h), omega);
    }
    ASSERT_EQ(run.advance(1), Outcome::done);
    Frame frame;
    run.look(frame);
    // Three leaps round each number some ten times; what 100 steps, a twentieth of a turn, make of it is below 10.
    const double bound = 64 * 0x1p-52 * 3 * (step == 1 ? 1 : 10 * std::sqrt(step));
    EXPECT_NEAR(frame.q[0], static_cast<double>(z.q), bound) << step;
    EXPECT_NEAR(frame.p[0], static_cast<double>(z.p), bound) << step;
  }
}

TEST(Tao, FollowsItsDefinition) {
  expect_definition<2>(20);
  expect_definition<4>(20);
  expect_definition<4>(3.7);
}

/// The largest error of H over 10^5 steps, relative to H.
double energy_error(double omega) {
  auto run = simulate(Quartic{}, Tao<2>{{.omega = omega}}, {start_q}, {start_p}, 0.001);
  EXPECT_EQ(run.advance(100000), Outcome::done);
  return run.energy().max_error / run.energy().initial;
}

TEST(Tao, KeepsTheEnergyAsLongAsTheCopiesAreBound) {
  // The modified energy differs from H by some (h omega_of_H)^2, omega_of_H^2 = H_qq H_pp = 10 and the turn 20 h twice.
  EXPECT_LT(energy_error(20), 0.01);
  EXPECT_GT(energy_error(1e-6), 0.3);  // the springs left out: the copies go each its way
}

/// How far from the start a run is that turned round on the way.
template <class Recipe>
double return_distance(const Recipe& recipe) {
  auto run = simulate(Quartic{}, recipe, {start_q}, {start_p}, 0.01);
  for (int way = 0; way < 2; ++way) {
    EXPECT_EQ(run.advance(500), Outcome::done);
    run.negate_momenta();
  }
  Frame frame;
  run.look(frame);
  return std::max(std::abs(frame.q[0] - start_q), std::abs(frame.p[0] - start_p));
}

/// A copy that runs on while the run turns round.
template <class P, class A>
struct DeafStep : TaoStep<P, A, 2> {
  using TaoStep<P, A, 2>::TaoStep;
  void negate_momenta() {}
};
struct Deaf : Tao<2> {
  template <class P, class A>
  using Stepper = DeafStep<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P&) const {
    return Stepper<P, A>(options);
  }
};

TEST(Tao, ComesBackWhenTheCopyTurnsToo) {
  EXPECT_LT(return_distance(Tao<2>{}), 1e-10);  // rounding, times what 1000 steps of a shear make of it
  EXPECT_GT(return_distance(Deaf{}), 1e-3);
}

}  // namespace
}  // namespace hamflow
