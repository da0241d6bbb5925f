// Typed Hamiltonians of built-in problems: the same bits from forces, velocities, gradients and energies as from the
// functions written by hand. Second derivatives, and what is written by hand in another way (the double pendulum by its
// velocities), agree to rounding.
#include <bit>
#include <random>

#include "../support/near.hpp"
#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/formula/bound_model.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/problems/duffing.hpp"
#include "hamflow/problems/harmonic.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/problems/lennard_jones_oscillator.hpp"
#include "hamflow/problems/of_any_size/fput.hpp"
#include "hamflow/problems/pendulum.hpp"
#include "hamflow/problems/potentials/binomial.hpp"
#include "hamflow/problems/potentials/hooke.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/problems/potentials/linear.hpp"
#include "hamflow/problems/potentials/power.hpp"
#include "hamflow/problems/sextic.hpp"
#include "hamflow/problems/support/polar.hpp"

namespace hamflow {
namespace {

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

/// How often bits differ in 5000 random states, and the largest relative distances.
struct Differences {
  int force = 0;
  int velocity = 0;
  int scaled = 0;
  int gradient = 0;
  int energy = 0;
  double worst_gradient = 0;
  double worst_hessian = 0;
};

template <class P>
Differences differences(const P& problem, const FormulaTexts& texts, double least = -2) {
  constexpr std::size_t fixed = P::dimension;
  const std::size_t n = degrees_of_freedom(problem);
  const auto model = std::make_shared<const formula::Model>(texts);
  const formula::BoundModel<double> typed(model, Parameters<double>(texts.parameters));
  EXPECT_EQ(model->structure().separable, Separable<P>) << texts.hamiltonian;
  EXPECT_EQ(model->structure().quadratic_kinetic, QuadraticKinetic<P>) << texts.hamiltonian;
  Differences d;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> number(least, 2);
  const auto distance = [](double a, double b, double size) { return std::fabs(a - b) / (size + 1); };
  for (int k = 0; k < 5000; ++k) {
    auto q = zeros<double, fixed>(n);
    auto p = zeros<double, fixed>(n);
    Vector<double, dynamic> tq(n);
    Vector<double, dynamic> tp(n);
    for (std::size_t i = 0; i < n; ++i) {
      tq[i] = q[i] = number(random);
      tp[i] = p[i] = number(random);
    }
    auto a = zeros<double, fixed>(n);
    auto b = zeros<double, fixed>(n);
    Vector<double, dynamic> ta(n);
    Vector<double, dynamic> tb(n);
    const auto count = [&](int& first, int& second) {
      for (std::size_t i = 0; i < n; ++i) {
        first += bits(a[i]) != bits(ta[i]);
        second += bits(b[i]) != bits(tb[i]);
      }
    };
    if constexpr (Separable<P>) {
      force(problem, q, a);
      velocity(problem, p, b);
      typed.force(tq, ta);
      typed.velocity(tp, tb);
      count(d.force, d.velocity);
      EXPECT_EQ((HasScaledForce<P, double>), typed.has_scaled());
      if (typed.has_scaled()) {
        scaled_force(problem, 0.123, q, a);
        scaled_velocity(problem, -0.77, p, b);
        typed.scaled_force(0.123, tq, ta);
        typed.scaled_velocity(-0.77, tp, tb);
        count(d.scaled, d.scaled);
      }
    }
    gradient(problem, q, p, a, b);
    typed.gradient(tq, tp, ta, tb);
    count(d.gradient, d.gradient);
    double size = 0;
    for (std::size_t i = 0; i < n; ++i) size += std::fabs(a[i]) + std::fabs(b[i]);
    for (std::size_t i = 0; i < n; ++i) {
      d.worst_gradient = std::max({d.worst_gradient, distance(a[i], ta[i], size), distance(b[i], tb[i], size)});
    }
    d.energy += bits(energy(problem, q, p)) != bits(typed.energy(tq, tp));
    Matrix<double, fixed> m[3]{zero_matrix(q), zero_matrix(q), zero_matrix(q)};
    Matrix<double, dynamic> t[3]{Matrix<double, dynamic>(n), Matrix<double, dynamic>(n), Matrix<double, dynamic>(n)};
    hessian(problem, q, p, m[0], m[1], m[2]);
    typed.hessian(tq, tp, t[0], t[1], t[2]);
    size = 0;
    for (const auto& all : m) {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) size += std::fabs(all[i][j]);
      }
    }
    for (std::size_t which = 0; which < 3; ++which) {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j)
          d.worst_hessian = std::max(d.worst_hessian, distance(m[which][i][j], t[which][i][j], size));
      }
    }
  }
  return d;
}

/// A second derivative is a sum of at most ten products of some ten factors.
constexpr double some_roundings = 100 * test::epsilon;

void expect_bits(const Differences& d, const char* name) {
  EXPECT_EQ(d.force, 0) << name;
  EXPECT_EQ(d.velocity, 0) << name;
  EXPECT_EQ(d.scaled, 0) << name;
  EXPECT_EQ(d.gradient, 0) << name;
  EXPECT_EQ(d.energy, 0) << name;
  EXPECT_LE(d.worst_hessian, some_roundings) << name;
}

FormulaTexts plane(const std::string& hamiltonian, const Texts& parameters) {
  return {.coordinates = {"x", "y"}, .hamiltonian = hamiltonian, .parameters = parameters};
}
FormulaTexts line(const std::string& hamiltonian, const Texts& parameters = {}) {
  return {.coordinates = {"q"}, .hamiltonian = hamiltonian, .parameters = parameters};
}

TEST(FormulaBits, OfCentralForces) {
  const Texts given{{"mu", "1.7"}, {"k", "1.3"}, {"lambda", "0.7"}};
  const auto typed = [&](const std::string& potential) { return plane("(p_x^2 + p_y^2)/(2*mu) " + potential, given); };
  const CentralForce<double, Kepler> kepler(1.7, Kepler<double>(1.3));
  expect_bits(differences(kepler, typed("- k/sqrt(x^2 + y^2)")), "kepler");
  expect_bits(differences(kepler, typed("- k*(x^2 + y^2)^(-1/2)")), "kepler, as a power");
  expect_bits(differences(kepler, plane("p_x^2/(2*mu) + p_y^2/2/mu + (let r = sqrt(x^2 + y^2) in -k/r)", given)),
              "kepler, by let");
  expect_bits(differences(CentralForce<double, Hooke>(1.7, Hooke<double>(1.3)), typed("- k*(x^2 + y^2)/2")), "hooke");
  expect_bits(differences(CentralForce<double, Linear>(1.7, Linear<double>(1.3)), typed("+ k*sqrt(x^2 + y^2)")),
              "linear");
  expect_bits(differences(CentralForce<double, Binomial>(1.7, Binomial<double>(1.3, 0.7)),
                          typed("+ k/2*(x^2 + y^2 - lambda)^2")),
              "binomial");
}

TEST(FormulaBits, OfOtherProblems) {
  const FormulaTexts henon_heiles{.coordinates = {"q1", "q2"},
                                  .hamiltonian = "(p1^2+p2^2)/2+(q1^2+q2^2)/2+q1^2*q2-q2^3/3"};
  expect_bits(differences(HenonHeiles<double>(), henon_heiles), "henon-heiles");
  const FormulaTexts with_lambda{.coordinates = {"q1", "q2"},
                                 .hamiltonian = "(p1^2 + p2^2 + q1^2 + q2^2)/2 + lambda*(q1^2*q2 - q2^3/3)",
                                 .parameters = {{"lambda", "0.7"}}};
  expect_bits(differences(HenonHeiles<double>(0.7), with_lambda), "henon-heiles with lambda");
  expect_bits(differences(Pendulum<double>(), line("p^2/2-cos(q)")), "pendulum");
  expect_bits(differences(Pendulum<double>(1.3, 0.7, 9.81),
                          line("p^2/(2*m*l^2) - m*g*l*cos(q)", {{"m", "1.3"}, {"l", "0.7"}, {"g", "9.81"}})),
              "pendulum of any length");
  expect_bits(
      differences(Harmonic<double>(1.3, 0.7), line("p^2/(2*m) + m*omega^2*q^2/2", {{"m", "1.3"}, {"omega", "0.7"}})),
      "harmonic");
  expect_bits(differences(LennardJonesOscillator<double>(), line("p^2/2+q^-12-2*q^-6"), 0.5), "lennard-jones");
  expect_bits(differences(LennardJonesOscillator<double>(), line("p^2/2 + 1/q^12 - 2/q^6"), 0.5),
              "lennard-jones, divided");
  expect_bits(differences(Duffing<double>(1.3, -1.7, 0.9), line("p^2/(2*mu)+alpha*q^2/2+beta*q^4/4",
                                                                {{"mu", "1.3"}, {"alpha", "-1.7"}, {"beta", "0.9"}})),
              "duffing");
  expect_bits(differences(Sextic<double>(), line("p^3/3 - p/2 + q^6/30 + q^4/4 - q^3/3 + 1/6")), "sextic");
}

/// By hand the tension of a link is nested in its length; of the typed sum the terms of equal power come together.
TEST(FormulaBits, OfAChainAgreeToRounding) {
  const FormulaTexts texts{.coordinates = {"q1", "q2", "q3", "q4"},
                           .hamiltonian =
                               "let r0 = q1, r1 = q2 - q1, r2 = q3 - q2, r3 = q4 - q3, r4 = -q4 in "
                               "(p1^2 + p2^2 + p3^2 + p4^2)/2 + (r0^2 + r1^2 + r2^2 + r3^2 + r4^2)/2 "
                               "+ alpha/3*(r0^3 + r1^3 + r2^3 + r3^3 + r4^3) "
                               "+ beta/4*(r0^4 + r1^4 + r2^4 + r3^4 + r4^4)",
                           .parameters = {{"alpha", "0.25"}, {"beta", "0.5"}}};
  const Differences d = differences(Fput<double>(4, 0.25, 0.5), texts);
  EXPECT_EQ(d.velocity, 0);
  EXPECT_LE(d.worst_gradient, 10 * test::epsilon);
  EXPECT_LE(d.worst_hessian, some_roundings);
}

/// Powers of r are powers of u = r^2 by hand, of which every term is added to the force; typed ones are collected.
TEST(FormulaBits, OfSumsOfPowersAgreeToRounding) {
  const CentralForce<double, Power> by_hand(1.7, Power<double>({0.5, -0.5}, {2, -2.5}));
  const Differences d = differences(
      by_hand, plane("(p_x^2 + p_y^2)/(2*m) + (let r = sqrt(x^2 + y^2) in 0.5*r^3 - 0.5*r^-1.5)", {{"m", "1.7"}}));
  EXPECT_LE(d.worst_gradient, 10 * test::epsilon);
  EXPECT_LE(d.worst_hessian, some_roundings);
}

/// By hand the gradient goes by the rate p_phi/r^2, which is rounded before it is multiplied.
TEST(FormulaBits, OfPolarFormsAgreeToRounding) {
  const auto typed = [](const std::string& potential, const Texts& parameters) {
    FormulaTexts texts{.coordinates = {"r", "phi"},
                       .hamiltonian = "(p_r^2 + p_phi^2/r^2)/(2*m) + (" + potential + ")",
                       .parameters = parameters};
    texts.parameters["m"] = "1.7";
    return texts;
  };
  for (const Differences& d :
       {differences(PolarCentralForce<double, Kepler>(1.7, Kepler<double>(1.3)), typed("-k/r", {{"k", "1.3"}}), 0.5),
        differences(PolarCentralForce<double, Hooke>(1.7, Hooke<double>(-1.3)), typed("-k*r^2/2", {{"k", "-1.3"}}),
                    0.5),
        differences(PolarCentralForce<double, Linear>(1.7, Linear<double>(1.3)), typed("k*r", {{"k", "1.3"}}), 0.5)}) {
    EXPECT_LE(d.worst_gradient, 10 * test::epsilon);
    EXPECT_LE(d.worst_hessian, some_roundings);
  }
}

/// By hand its gradient goes by the velocities, with a determinant that is a sum of positive terms; the typed one
/// divides by 5 - 4 cos^2, which loses up to a factor 4/(5 - 4) of its digits.
TEST(FormulaBits, OfTheDoublePendulumAgreeToRounding) {
  const FormulaTexts texts{.coordinates = {"q1", "q2"},
                           .hamiltonian =
                               "(p1^2-4*cos(q1-q2)*p1*p2+5*p2^2)/(2*m*l^2*(5-4*cos(q1-q2)^2))"
                               "-m*g*l*(3*cos(q1)+cos(q2))",
                           .parameters = {{"m", "2"}, {"l", "3"}, {"g", "9.81"}}};
  const Differences d = differences(DoublePendulumNonlinearAbsolute<double>({2, 2}, {3, 3}, {0, 0}, 9.81), texts);
  EXPECT_LE(d.worst_gradient, 10 * test::epsilon);
  EXPECT_LE(d.worst_hessian, some_roundings);
}

}  // namespace
}  // namespace hamflow
