// The double pendulum: entries of its Hamiltonian, derivatives by hand, both sets of angles, modes.
#include "../support/exact_motion.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/problems/double_pendulum_linear_absolute.hpp"
#include "hamflow/problems/double_pendulum_linear_relative.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_relative.hpp"

namespace hamflow {
namespace {

using Long = long double;
using Pair = Vector<Long, 2>;
using Square = Matrix<Long, 2>;
using test::distance_from_reference;
using test::long_epsilon;
using test::reference_units;
using test::within;

static_assert(Smooth<DoublePendulumNonlinearAbsolute<>> && !Separable<DoublePendulumNonlinearRelative<>>);
static_assert(QuadraticKinetic<DoublePendulumLinearAbsolute<>> && QuadraticKinetic<DoublePendulumLinearRelative<>>);

/// Uncommon values, so that a forgotten one shows.
template <class P>
P uncommon() {
  return P({1.7L, 0.6L}, {0.9L, 1.3L}, {0.4L, 0.25L}, 9.81L);
}
template <class P>
P equal_case(Long m, Long l) {
  return P({m, m}, {l, l}, {0, 0}, 9.81L);
}

Pair random_pair(std::uint64_t seed, std::uint64_t k, Long size) {
  return {size * static_cast<Long>(counter_uniform(seed, 2 * k)),
          size * static_cast<Long>(counter_uniform(seed, 2 * k + 1))};
}

template <class T>
class Nonlinear : public ::testing::Test {};
using NonlinearForms = ::testing::Types<DoublePendulumNonlinearAbsolute<Long>, DoublePendulumNonlinearRelative<Long>>;
TYPED_TEST_SUITE(Nonlinear, NonlinearForms);

/// How far the derivatives by hand are from those that nested dual numbers find of the energy, over all entries.
template <class P>
Long derivative_error(const P& by_hand, const P& energy_of, const Pair& q, const Pair& p) {
  using D = Dual<Long, 4>;
  using DD = Dual<D, 4>;
  Vector<DD, 2> dual_q{};
  Vector<DD, 2> dual_p{};
  for (std::size_t k = 0; k < 2; ++k) {
    dual_q[k] = DD::variable(D::variable(q[k], k), k);
    dual_p[k] = DD::variable(D::variable(p[k], 2 + k), 2 + k);
  }
  const DD h = energy_of.energy(dual_q, dual_p);
  Pair dq{};
  Pair dp{};
  Square hqq{};
  Square hqp{};
  Square hpp{};
  by_hand.gradient(q, p, dq, dp);
  by_hand.hessian(q, p, hqq, hqp, hpp);
  Long error = 0;
  const auto compare = [&](Long a, Long b) { error = larger(error, static_cast<Long>(std::fabs(a - b))); };
  compare(by_hand.energy(q, p), value_of(h));
  for (std::size_t i = 0; i < 2; ++i) {
    compare(dq[i], h.slope[i].value);
    compare(dp[i], h.slope[2 + i].value);
    for (std::size_t j = 0; j < 2; ++j) {
      compare(hqq[i][j], h.slope[i].slope[j]);
      compare(hqp[i][j], h.slope[i].slope[2 + j]);
      compare(hpp[i][j], h.slope[2 + i].slope[2 + j]);
    }
  }
  return error;
}

TYPED_TEST(Nonlinear, DerivativesByHandAreThoseOfTheEnergy) {
  const auto problem = uncommon<TypeParam>();
  const TypeParam other({1.7L, 0.6L}, {0.9L, 1.3L}, {0.4L, 0.2500001L}, 9.81L);
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Pair q = random_pair(61, i, 4);
    const Pair p = random_pair(62, i, 5);
    // |p|^2 |M^-1| |M''| |M^-1| ~ 400, and a condition of M below 50.
    EXPECT_LE(derivative_error(problem, problem, q, p), 400 * 50 * long_epsilon);
    EXPECT_GT(derivative_error(problem, other, q, p), 400 * 50 * long_epsilon);  // an inertia off by 5e-8 shows
  }
}

/// The same template in double, against long double with the same numbers.
TEST(DoublePendulum, DerivativesInDouble) {
  const DoublePendulumNonlinearRelative<double> problem({1.5, 0.625}, {0.875, 1.25}, {0.375, 0.25}, 9.75);
  const DoublePendulumNonlinearRelative<Long> exact({1.5L, 0.625L}, {0.875L, 1.25L}, {0.375L, 0.25L}, 9.75L);
  for (std::uint64_t i = 0; i < 50; ++i) {
    const auto q = cast<double>(random_pair(74, i, 4));
    const auto p = cast<double>(random_pair(75, i, 5));
    Vector<double, 2> dq{};
    Vector<double, 2> dp{};
    Pair exact_dq{};
    Pair exact_dp{};
    problem.gradient(q, p, dq, dp);
    exact.gradient(cast<Long>(q), cast<Long>(p), exact_dq, exact_dp);
    Matrix<double, 2> hqq{};
    Matrix<double, 2> hqp{};
    Matrix<double, 2> hpp{};
    Square exact_hqq{};
    Square exact_hqp{};
    Square exact_hpp{};
    problem.hessian(q, p, hqq, hqp, hpp);
    exact.hessian(cast<Long>(q), cast<Long>(p), exact_hqq, exact_hqp, exact_hpp);
    for (std::size_t r = 0; r < 2; ++r) {
      EXPECT_TRUE(within(dq[r], exact_dq[r], 400 * 50 * test::epsilon));
      EXPECT_TRUE(within(dp[r], exact_dp[r], 400 * 50 * test::epsilon));
      for (std::size_t c = 0; c < 2; ++c) {
        EXPECT_TRUE(within(hqq[r][c], exact_hqq[r][c], 400 * 50 * test::epsilon));
        EXPECT_TRUE(within(hqp[r][c], exact_hqp[r][c], 400 * 50 * test::epsilon));
        EXPECT_TRUE(within(hpp[r][c], exact_hpp[r][c], 400 * 50 * test::epsilon));
      }
    }
  }
}

TYPED_TEST(Nonlinear, MassMatrixAndItsInverse) {
  const auto problem = uncommon<TypeParam>();
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Pair q = random_pair(63, i, 4);
    const Pair p = random_pair(64, i, 5);
    const Square m = problem.mass_matrix(q);
    const Square inverse = problem.inverse_mass_matrix(q);
    Pair dq{};
    Pair v{};
    problem.gradient(q, p, dq, v);
    for (std::size_t r = 0; r < 2; ++r) {
      EXPECT_TRUE(within(m[r][0] * v[0] + m[r][1] * v[1], p[r], 512 * long_epsilon));  // p = M q'
      for (std::size_t c = 0; c < 2; ++c) {
        EXPECT_TRUE(within(m[r][0] * inverse[0][c] + m[r][1] * inverse[1][c], r == c, 512 * long_epsilon));
      }
    }
  }
}

/// T and V from the positions of the masses themselves.
TYPED_TEST(Nonlinear, EnergyIsThatOfTheMassesInThePlane) {
  const Pair m{1.7L, 0.6L};
  const Pair l{0.9L, 1.3L};
  const Pair theta{0.4L, 0.25L};
  const Long g = 9.81L;
  const auto problem = uncommon<TypeParam>();
  const bool relative = TypeParam::info().variant[1].second == "relative";
  for (std::uint64_t i = 0; i < 50; ++i) {
    using D = Dual<Long, 1>;  // the derivative with respect to time
    const Pair q = random_pair(65, i, 4);
    const Pair v = random_pair(66, i, 3);
    Vector<D, 2> angle{};
    for (std::size_t k = 0; k < 2; ++k) {
      angle[k] = D(q[k]);
      angle[k].slope[0] = v[k];
    }
    if (relative) angle = absolute_angles(angle);
    const D x1 = l[0] * sin(angle[0]);
    const D y1 = -l[0] * cos(angle[0]);  // upwards
    const D x2 = 2 * l[0] * sin(angle[0]) + l[1] * sin(angle[1]);
    const D y2 = -2 * l[0] * cos(angle[0]) - l[1] * cos(angle[1]);
    const auto square = [](Long x) { return x * x; };
    const Long expected = m[0] / 2 * (square(x1.slope[0]) + square(y1.slope[0])) +
                          m[1] / 2 * (square(x2.slope[0]) + square(y2.slope[0])) +
                          theta[0] / 2 * square(angle[0].slope[0]) + theta[1] / 2 * square(angle[1].slope[0]) +
                          g * (m[0] * y1.value + m[1] * y2.value);
    const Square mass = problem.mass_matrix(q);
    const Pair p{mass[0][0] * v[0] + mass[0][1] * v[1], mass[1][0] * v[0] + mass[1][1] * v[1]};
    EXPECT_TRUE(within(problem.energy(q, p), expected, 100 * 50 * long_epsilon));  // T up to about 100
  }
}

TYPED_TEST(Nonlinear, AtRestItIsTheLinearModel) {
  constexpr bool relative = std::is_same_v<TypeParam, DoublePendulumNonlinearRelative<Long>>;
  const auto linear = uncommon<DoublePendulumLinear<Long, relative ? Angles::relative : Angles::absolute>>();
  Square hqq{};
  Square hqp{};
  Square hpp{};
  uncommon<TypeParam>().hessian(Pair{0, 0}, Pair{0, 0}, hqq, hqp, hpp);
  EXPECT_EQ(hqq, linear.stiffness_matrix());
  EXPECT_EQ(hqp, Square{});
  EXPECT_EQ(hpp, linear.inverse_mass_matrix());
}

TEST(DoublePendulum, EqualCaseHasTheMatricesOfTheThesis) {
  const Long m = 2;
  const Long l = 3;
  const Pair q{0.3L, -1.1L};
  const auto absolute = equal_case<DoublePendulumNonlinearAbsolute<Long>>(m, l);
  const auto relative = equal_case<DoublePendulumNonlinearRelative<Long>>(m, l);
  const Long s = m * l * l;
  const Long c = std::cos(q[0] - q[1]);
  const Long c2 = std::cos(q[1]);
  const Square expected{Pair{5 * s, 2 * s * c}, Pair{2 * s * c, s}};                                    // (3.149)
  const Square expected_relative{Pair{s * (6 + 4 * c2), s * (1 + 2 * c2)}, Pair{s * (1 + 2 * c2), s}};  // (3.175)
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_TRUE(within(absolute.mass_matrix(q)[i][j], expected[i][j], 4 * 10 * s * long_epsilon));
      EXPECT_TRUE(within(relative.mass_matrix(q)[i][j], expected_relative[i][j], 4 * 10 * s * long_epsilon));
    }
  }
  const Long mgl = m * 9.81L * l;
  const Pair zero{0, 0};
  EXPECT_TRUE(within(absolute.energy(q, zero), -mgl * (3 * std::cos(q[0]) + std::cos(q[1])), 16 * mgl * long_epsilon));
  EXPECT_TRUE(
      within(relative.energy(q, zero), -mgl * (3 * std::cos(q[0]) + std::cos(q[0] + q[1])), 16 * mgl * long_epsilon));
  // The start of figure 3.21 lies m g l above the rest.
  const Pair start{0, pi_value<Long>() / 2};
  EXPECT_TRUE(within(absolute.energy(start, zero) - absolute.energy(zero, zero), mgl, 8 * mgl * long_epsilon));
  EXPECT_TRUE(within(relative.energy(start, zero) - relative.energy(zero, zero), mgl, 8 * mgl * long_epsilon));
  // Remark 3.2, and its form in relative angles.
  const DoublePendulumLinearAbsolute<Long> body({m, m}, {l, l}, {0.5L, 0.25L});
  const DoublePendulumLinearRelative<Long> body_relative({m, m}, {l, l}, {0.5L, 0.25L});
  EXPECT_EQ(body.mass_matrix(), (Square{Pair{5 * s + 0.5L, 2 * s}, Pair{2 * s, s + 0.25L}}));
  EXPECT_EQ(body_relative.mass_matrix(), (Square{Pair{10 * s + 0.75L, 3 * s + 0.25L}, Pair{3 * s + 0.25L, s + 0.25L}}));
  EXPECT_EQ(equal_case<DoublePendulumLinearRelative<Long>>(m, l).stiffness_matrix(),
            (Square{Pair{4 * mgl, mgl}, Pair{mgl, mgl}}));  // (3.94)
}

/// Velocities and conditions of M^-1 that the program of appendix C finds along the motion of figure 3.21.
TEST(DoublePendulum, VelocitiesAndConditionsOfTheListing) {
  struct Row {
    Pair q, p, v;
    Long condition;
  };
  const Row rows[] = {{{0, 1.5707963267948966L}, {0, 0}, {0, 0}, 5},
                      {{0.4762833029106188L, -0.440831773642666L},
                       {-26.71273178833913L, -33.89773088390021L},
                       {0.22902911792716035L, -2.1617583853368583L},
                       10.97520984867064L},
                      {{0.01318671536516513L, 0.8800521363190048L},
                       {65.82864264433833L, -0.8740296193788225L},
                       {1.118989459562824L, -1.4970201824338267L},
                       11.917822341675098L}};
  const auto problem = equal_case<DoublePendulumNonlinearAbsolute<Long>>(2, 3);
  for (const Row& row : rows) {
    Pair dq{};
    Pair v{};
    problem.gradient(row.q, row.p, dq, v);
    const Square m = problem.mass_matrix(row.q);
    const Square w = problem.inverse_mass_matrix(row.q);
    const auto norm = [](const Square& a) {
      return std::max(std::fabs(a[0][0]) + std::fabs(a[0][1]), std::fabs(a[1][0]) + std::fabs(a[1][1]));
    };
    // Printed in double; M^-1 amplifies the rounding of q by at most its condition.
    for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(within(v[i], row.v[i], 64 * row.condition * test::epsilon));
    EXPECT_TRUE(within(norm(m) * norm(w), row.condition, 64 * row.condition * row.condition * test::epsilon));
  }
}

TEST(PendulumAngles, ChangeIsCanonicalAndRound) {
  // J^T Omega J = Omega for the Jacobian of (q, p) absolute -> relative. All entries are -1, 0, 1: no rounding.
  Matrix<Long, 4> jacobian{};
  for (std::size_t k = 0; k < 4; ++k) {
    Pair q{};
    Pair p{};
    (k < 2 ? q[k] : p[k - 2]) = 1;
    const Pair new_q = relative_angles(q);
    const Pair new_p = relative_momenta(p);
    for (std::size_t i = 0; i < 2; ++i) {
      jacobian[i][k] = new_q[i];
      jacobian[2 + i][k] = new_p[i];
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      Long sum = 0;
      for (std::size_t k = 0; k < 2; ++k)
        sum += jacobian[k][i] * jacobian[2 + k][j] - jacobian[2 + k][i] * jacobian[k][j];
      EXPECT_EQ(sum, Long(j == i + 2) - Long(i == j + 2));
    }
  }
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Pair x = random_pair(67, i, 4);
    const Pair angles = absolute_angles(relative_angles(x));
    const Pair momenta = absolute_momenta(relative_momenta(x));
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_TRUE(within(angles[k], x[k], 8 * long_epsilon));
      EXPECT_TRUE(within(momenta[k], x[k], 8 * long_epsilon));
    }
  }
  const Pair thesis = relative_angles(Pair{0.1L, -0.01L});  // tables 3.1, 3.2
  EXPECT_TRUE(within(thesis[1], -0.11L, long_epsilon));
}

TEST(PendulumAngles, ChangePreservesEnergyAndMotion) {
  const auto absolute = uncommon<DoublePendulumNonlinearAbsolute<Long>>();
  const auto relative = uncommon<DoublePendulumNonlinearRelative<Long>>();
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Pair q = random_pair(68, i, 4);
    const Pair p = random_pair(69, i, 5);
    const Pair rq = relative_angles(q);
    const Pair rp = relative_momenta(p);
    const Long bound = 400 * 50 * long_epsilon;
    EXPECT_TRUE(within(absolute.energy(q, p), relative.energy(rq, rp), bound));
    Pair dq{};
    Pair dp{};
    Pair rdq{};
    Pair rdp{};
    absolute.gradient(q, p, dq, dp);
    relative.gradient(rq, rp, rdq, rdp);
    const Pair changed_v = relative_angles(dp);
    const Pair changed_force = relative_momenta(dq);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_TRUE(within(rdp[k], changed_v[k], bound));
      EXPECT_TRUE(within(rdq[k], changed_force[k], bound));
    }
    EXPECT_FALSE(within(relative.energy(rq, p), absolute.energy(q, p), bound));  // momenta have to change too
    const auto linear = uncommon<DoublePendulumLinearAbsolute<Long>>();
    const auto linear_relative = uncommon<DoublePendulumLinearRelative<Long>>();
    EXPECT_TRUE(within(energy(linear, q, p), energy(linear_relative, rq, rp), bound));
  }
}

/// `analytic` of the reference listing of ch. 3.1 (m = 0.25, l = 0.5, absolute angles), in double.
struct AnalyticRow {
  int start;
  Long t;
  Pair q, v, p;
};
const Pair table31[] = {{-2.605551275463989L, 6}, {4.60555127546399L, 6}, {0.1L, -0.01L}};
const AnalyticRow analytic[] = {{0,
                                 0.5L,
                                 {-2.5655808091896795L, 5.9079569840347315L},
                                 {-5.553634235944817L, 12.788773619408065L},
                                 {-0.13691399630674717L, 0.10509407171990193L}},
                                {0,
                                 1,
                                 {-2.4468957444552264L, 5.634651908401588L},
                                 {-10.936877390341522L, 25.18517480734033L},
                                 {-0.2696273335641841L, 0.2069637516660805L}},
                                {0,
                                 10,
                                 {2.432882718482234L, -5.602383053580075L},
                                 {11.393817721925343L, -26.237405870808733L},
                                 {0.2808923042505782L, -0.21561065168487792L}},
                                {1,
                                 0.5L,
                                 {0.8237861702898199L, 1.0732085533541176L},
                                 {-12.605656603429702L, -16.422342320563658L},
                                 {-5.992060478642239L, -2.602103470463941L}},
                                {1,
                                 10,
                                 {-4.136734730889327L, -5.389237227162434L},
                                 {-5.63194946907481L, -7.337166561248303L},
                                 {-2.677130029241916L, -1.1625665937123701L}},
                                {2,
                                 0.5L,
                                 {0.0492369264675799L, -0.0739809671541105L},
                                 {-0.08429111165583072L, -0.40880874123881794L},
                                 {-0.07744206504729934L, -0.03608693528440496L}},
                                {2,
                                 5,
                                 {0.006700975773639009L, 0.03426452534981153L},
                                 {0.3017429771806148L, -1.2918428157537212L},
                                 {-0.06718567160027301L, -0.04302230383703072L}},
                                {2,
                                 10,
                                 {-0.09120272890039274L, 0.012164747707304455L},
                                 {-0.24484154875475211L, 0.29444629105868697L},
                                 {-0.03970719760352417L, -0.012202300403176079L}}};

TEST(DoublePendulum, ModesAreThoseOfTheListing) {
  const auto problem = equal_case<DoublePendulumLinearAbsolute<Long>>(0.25L, 0.5L);
  const auto relative = equal_case<DoublePendulumLinearRelative<Long>>(0.25L, 0.5L);
  for (const AnalyticRow& row : analytic) {
    const Pair q0 = table31[row.start];
    const auto z = *problem.exact(q0, {0, 0}, row.t);
    Pair v{};
    problem.velocity(z.p, v);
    // The listing works in double: the phase omega t <= 122 and the starts carry its rounding.
    const Long bound = 8 * (1 + 12.3L * row.t) * test::epsilon * test::size_of(q0);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_TRUE(within(z.q[k], row.q[k], bound));
      EXPECT_TRUE(within(v[k], row.v[k], 12.3L * bound));
      EXPECT_TRUE(within(z.p[k], row.p[k], 12.3L * bound));
    }
    const auto r = *relative.exact(relative_angles(q0), {0, 0}, row.t);
    const Pair back = absolute_angles(r.q);
    const Pair momenta = absolute_momenta(r.p);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_TRUE(within(back[k], row.q[k], bound));
      EXPECT_TRUE(within(momenta[k], row.p[k], 12.3L * bound));
    }
  }
}

TEST(DoublePendulum, AmplitudesOfTheGenericStart) {
  // A_i, B_i of (3.33) with eigenforms whose second entry is 1; the faster mode comes first there.
  const auto problem = equal_case<DoublePendulumLinearAbsolute<Long>>(0.25L, 0.5L);
  const ModalSolution<2> modes = problem.modes();
  const Pair a{-0.8251853986406111L, 0.01518539864061106L};
  const Pair b{-0.05979190753759405L, 0.46025539364295043L};
  const Pair q{0.37L, -0.81L};
  const Pair v{1.3L, 0.55L};
  const Square m = problem.mass_matrix();
  const Pair p{m[0][0] * v[0] + m[0][1] * v[1], m[1][0] * v[0] + m[1][1] * v[1]};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t k = 1 - i;
    EXPECT_TRUE(within(modes.modal_position(q)[k] * modes.form(k)[1], a[i], 16 * test::epsilon));
    EXPECT_TRUE(within(modes.modal_velocity(p)[k] / std::sqrt(modes.eigenvalues()[k]) * modes.form(k)[1], b[i],
                       16 * test::epsilon));
    const Long root = i == 0 ? -std::sqrt(13.0L) : std::sqrt(13.0L);
    EXPECT_TRUE(within(modes.form(k)[0] / modes.form(k)[1], (1 + root) / 6, 32 * long_epsilon));  // (3.71), (3.72)
  }
}

TEST(DoublePendulum, EqualCaseHasItsFrequencies) {
  for (const Long l : {0.5L, 3.0L}) {
    for (const Long m : {0.25L, 2.0L}) {
      const Pair absolute = equal_case<DoublePendulumLinearAbsolute<Long>>(m, l).modes().eigenvalues();
      const Pair relative = equal_case<DoublePendulumLinearRelative<Long>>(m, l).modes().eigenvalues();
      const Long high = (4 + std::sqrt(13.0L)) * 9.81L / l;  // (3.64), (3.65)
      const Long low = (4 - std::sqrt(13.0L)) * 9.81L / l;
      // The eigenvalues of the symmetric problem err by eps times the largest; M has a condition below 200.
      for (const Pair& found : {absolute, relative}) {
        EXPECT_TRUE(within(found[0], low, 200 * high * long_epsilon));
        EXPECT_TRUE(within(found[1], high, 200 * high * long_epsilon));
      }
    }
  }
}

TEST(DoublePendulum, LinearExactIsTheReferenceFlow) {
  for (std::uint64_t i = 0; i < 15; ++i) {
    const Start<Long, 2> start{random_pair(71, i, 1), random_pair(72, i, 1)};
    const Long t = 5 * static_cast<Long>(counter_uniform(73, i));
    EXPECT_LE(distance_from_reference(uncommon<DoublePendulumLinearAbsolute<Long>>(), start, t), reference_units);
    EXPECT_LE(distance_from_reference(uncommon<DoublePendulumLinearRelative<Long>>(), start, t), reference_units);
    // Without gravity, and upside down: eigenvalues zero and negative.
    const DoublePendulumLinearRelative<Long> free({1, 2}, {1, 0.5L}, {0, 0.1L}, 0);
    EXPECT_LE(distance_from_reference(free, start, t), reference_units);
    const DoublePendulumLinearAbsolute<Long> inverted({1, 2}, {1, 0.5L}, {0, 0.1L}, -0.3L);
    EXPECT_LE(distance_from_reference(inverted, start, t), reference_units);
  }
}

/// M q'' + C q = 0 with four degrees of freedom.
struct Chain {
  using Real = Long;
  static constexpr std::size_t dimension = 4;
  static constexpr bool quadratic_kinetic = true;
  Matrix<Long, 4> mass{};
  Matrix<Long, 4> inverse{};
  Matrix<Long, 4> stiffness{};

  explicit Chain(std::uint64_t seed) {
    std::uint64_t k = 0;
    const auto draw = [&] { return static_cast<Long>(counter_uniform(seed, k++)); };
    Matrix<Long, 4> root{};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        root[i][j] = (i == j ? 2 : 0) + draw() / 2;
        const Long indefinite = draw();
        stiffness[i][j] += indefinite;
        stiffness[j][i] += indefinite;
      }
    }
    for (std::size_t i = 0; i < 4; ++i) mass[i] = apply(root, root[i]);
    inverse = hamflow::inverse(mass);
  }
  template <class S>
  static S form(const Matrix<Long, 4>& m, const Vector<S, 4>& x) {
    S sum(0);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) sum += x[i] * x[j] * m[i][j];
    }
    return sum / Long(2);
  }
  template <class S>
  S kinetic(const Vector<S, 4>& p) const {
    return form(inverse, p);
  }
  template <class S>
  S potential(const Vector<S, 4>& q) const {
    return form(stiffness, q);
  }
  std::optional<Start<Long, 4>> exact(const Vector<Long, 4>& q, const Vector<Long, 4>& p, Long t) const {
    return ModalSolution<4>(mass, stiffness).at(q, p, t);
  }
};

TEST(Modal, FourDegreesOfFreedomWithStableAndUnstableModes) {
  int unstable = 0;
  int stable = 0;
  for (std::uint64_t seed = 81; seed < 86; ++seed) {
    const Chain chain(seed);
    const ModalSolution<4> solution(chain.mass, chain.stiffness);
    for (const Long x : solution.eigenvalues()) ++(x < 0 ? unstable : stable);
    for (const Long t : {0.0L, 1.0L, -4.0L}) {
      const Start<Long, 4> start{{0.3L, -0.5L, 0.1L, 0.9L}, {-0.2L, 0.4L, 0.8L, -0.6L}};
      EXPECT_LE(distance_from_reference(chain, start, t), reference_units);
    }
  }
  EXPECT_GT(unstable, 2);
  EXPECT_GT(stable, 2);
  Chain wrong(81);
  wrong.mass[1][2] += 1e-12L;
  wrong.mass[2][1] += 1e-12L;
  EXPECT_GT(distance_from_reference(wrong, {{0.3L, -0.5L, 0.1L, 0.9L}, {-0.2L, 0.4L, 0.8L, -0.6L}}, 2),
            reference_units);
  Matrix<Long, 4> not_positive = Chain(81).mass;
  not_positive[3][3] = -1;
  EXPECT_FALSE(ModalSolution<4>(not_positive, Chain(81).stiffness).solved());
}

TEST(DoublePendulum, DeclaresItself) {
  const ProblemInfo info = DoublePendulumNonlinearRelative<>::info();
  EXPECT_EQ(info.name, "double-pendulum");
  EXPECT_EQ(info.variant, (std::vector<std::pair<std::string, std::string>>{
                              {"model", "nonlinear"}, {"angles", "relative"}, {"coordinates", "generalised"}}));
  std::map<std::string, std::string> defaults;
  for (const ParameterInfo& p : info.parameters) defaults[p.name] = p.default_value;
  const Parameters<Long> given(defaults);
  const Pair q{0.3L, 0.2L};
  const Pair p{1, -2};
  EXPECT_EQ(DoublePendulumNonlinearRelative<Long>(given).energy(q, p),
            DoublePendulumNonlinearRelative<Long>().energy(q, p));
  EXPECT_EQ(DoublePendulumNonlinearRelative<Long>::refused_parameters(given).second, "");
  defaults["masses"] = "[1e-200, 1]";
  defaults["half_lengths"] = "[1e-100, 1]";
  EXPECT_NE(DoublePendulumLinearAbsolute<double>::refused_parameters(Parameters<double>(defaults)).second, "");
}

}  // namespace
}  // namespace hamflow
