// The Duffing oscillator: cases of Gross1999, phase curve, periods, exact solution in time.
#include "hamflow/problems/duffing.hpp"

#include "../support/exact_motion.hpp"
#include "hamflow/core/counter_random.hpp"

namespace hamflow {
namespace {

using Long = long double;
using test::distance_from_reference;
using test::long_epsilon;
using test::reference_units;
using test::within;
using Start1 = Start<Long, 1>;

struct Figure {
  const char* kind;
  std::map<std::string, std::string> problem;
  std::map<std::string, std::string> orbit;
  double lambda;
  double energy;
};

const Figure figures[] = {
    {"case1", {{"mass", "2"}, {"k", "1"}}, {{"r0", "4"}, {"speed", "4"}}, 7, 40.5},  // figure 2.26
    {"case2", {{"mass", "2"}, {"k", "1"}}, {{"r0", "4"}}, 8, 32},                    // figure 2.27
    {"case3", {{"mass", "2"}, {"k", "2"}}, {{"r0", "4"}, {"speed", "4"}}, 12, 16}};  // figure 2.28

TEST(Duffing, FiguresHaveTheirLambdaAndEnergy) {
  for (const Figure& figure : figures) {
    SCOPED_TRACE(figure.kind);
    Parameters<double> given(figure.problem);
    const Parameters<double> orbit(figure.orbit);
    Duffing<double>::derive(figure.kind, orbit, given);
    EXPECT_EQ(given["lambda"], figure.lambda);  // small whole numbers: no rounding
    EXPECT_EQ(Duffing<double>::refused_parameters(given).second, "");
    Conditions conditions;
    const Start<double, 1> start = Duffing<double>::start(figure.kind, given, orbit, conditions);
    for (const Condition& c : conditions.all()) EXPECT_TRUE(c.holds()) << c.statement;
    const Duffing<double> problem(given);
    EXPECT_EQ(energy(problem, start.q, start.p), figure.energy);
    EXPECT_EQ(problem.kinetic(start.p), 0);
  }
}

TEST(Duffing, CasesHaveTheSpeedsThatWereGiven) {
  for (std::uint64_t i = 0; i < 30; ++i) {
    const Long mass = 1.5L + counter_uniform(51, 3 * i);
    const Long k = 1.5L + counter_uniform(51, 3 * i + 1);
    const Long r0 = 2.5L + counter_uniform(51, 3 * i + 2);
    const Long largest = std::sqrt(k / mass) * r0 * r0 / 2;
    const auto energy_of = [&](Long lambda, Long x, Long v) {
      return mass * v * v / 2 + k / 2 * (x * x - lambda) * (x * x - lambda);
    };
    const auto one = duffing_case1(mass, k, r0, 3.0L);
    EXPECT_LT(one.lambda, one.lambda_inf);
    const Long scale = 64 * long_epsilon * (k * r0 * r0 * r0 * r0 + mass * 9);
    EXPECT_TRUE(within(energy_of(one.lambda, 0, 3), energy_of(one.lambda, r0, 0), scale));
    EXPECT_TRUE(within(energy_of(one.lambda, r0, 0), k * one.lambda_inf * one.lambda_inf / 2, scale));
    const auto two = duffing_case2(r0);
    EXPECT_TRUE(within(energy_of(two.lambda, 0, 0), energy_of(two.lambda, r0, 0), scale));
    const Long speed = 0.3L * largest;
    const auto three = duffing_case3(mass, k, r0, speed);
    EXPECT_GT(three.lambda, three.lambda_inf);
    EXPECT_LE(three.lambda, r0 * r0);
    EXPECT_TRUE(within(energy_of(three.lambda, std::sqrt(three.lambda), speed), energy_of(three.lambda, r0, 0), scale));
  }
}

TEST(Duffing, ImpossibleCasesSayWhichInequalityFails) {
  const auto failing = [](const char* kind, std::map<std::string, std::string> given,
                          const std::map<std::string, std::string>& orbit) {
    Conditions conditions;
    given.insert({"mass", "2"});
    (void)Duffing<double>::start(kind, Parameters<double>(given), Parameters<double>(orbit), conditions);
    for (const Condition& c : conditions.all()) {
      if (!c.holds()) return c.key + ": " + c.statement;
    }
    return std::string();
  };
  EXPECT_EQ(failing("case3", {{"k", "2"}}, {{"r0", "4"}, {"speed", "7.9"}}), "");
  EXPECT_EQ(failing("case3", {{"k", "2"}}, {{"r0", "4"}, {"speed", "8"}}),
            "problem.speed: speed < sqrt(k/mass) r0^2/2");
  EXPECT_EQ(failing("case1", {{"k", "2"}}, {{"r0", "4"}, {"speed", "0"}}), "problem.speed: 0 < speed");
  EXPECT_EQ(failing("case1", {{"k", "-2"}}, {{"r0", "4"}, {"speed", "1"}}), "problem.k: 0 < k");
  EXPECT_EQ(failing("case1", {}, {{"r0", "4"}, {"speed", "1"}}), "problem.k: 0 < k");
  EXPECT_EQ(failing("case2", {{"k", "2"}}, {{"r0", "-4"}}), "problem.r0: 0 < r0");
  using Given = std::map<std::string, std::string>;
  const auto complaint = [](const Given& given) {
    return Duffing<double>::refused_parameters(Parameters<double>(given)).second;
  };
  EXPECT_EQ(complaint({{"alpha", "1"}, {"beta", "0"}}), "");
  EXPECT_NE(complaint({{"alpha", "1"}, {"beta", "0"}, {"k", "1"}}), "");
  EXPECT_NE(complaint({{"alpha", "1"}}), "");
  EXPECT_NE(complaint({{"lambda", "1"}}), "");
  EXPECT_NE(complaint({}), "");
}

TEST(Duffing, BothSetsOfKeysAreOneHamiltonianUpToGamma) {
  const Duffing<double> a(Parameters<double>({{"mass", "2"}, {"k", "0.5"}, {"lambda", "3"}}));
  const Duffing<double> b(Parameters<double>({{"mass", "2"}, {"alpha", "-3"}, {"beta", "1"}}));
  for (const double x : {-2.5, 0.0, 1.0}) {
    EXPECT_EQ(a.potential(Vector<double, 1>{x}), b.potential(Vector<double, 1>{x}) + 2.25);
    EXPECT_EQ(a.potential(Vector<double, 1>{x}), 0.25 * (x * x - 3) * (x * x - 3));
  }
}

/// Motions of every kind; nothing is returned where they are unbounded.
TEST(Duffing, ExactIsTheReferenceFlow) {
  Long worst = 0;
  int motions[3][3] = {};  // by the signs of beta and alpha
  for (std::uint64_t i = 0; i < 400; ++i) {
    const Long mass = 1.3L;
    const Long alpha = i % 7 == 0 ? 0 : 2 * static_cast<Long>(counter_uniform(52, 5 * i));
    const Long beta = i % 11 == 0 ? 0 : 2 * static_cast<Long>(counter_uniform(52, 5 * i + 1));
    const Duffing<Long> problem(mass, alpha, beta);
    const Start1 start{{1.2L * static_cast<Long>(counter_uniform(52, 5 * i + 2))},
                       {1.2L * static_cast<Long>(counter_uniform(52, 5 * i + 3))}};
    const Long t = 7 * static_cast<Long>(counter_uniform(52, 5 * i + 4));
    const Long x = start.q[0];
    const Long p = start.p[0];
    const Long energy_left = alpha * alpha / (-4 * beta) - energy(problem, start.q, start.p);
    const bool bounded = beta >= 0 || (alpha > 0 && energy_left > 0 && alpha + beta * x * x > 0);
    ASSERT_EQ(problem.exact(start.q, start.p, t).has_value(), bounded) << i;
    if (!bounded) continue;
    ++motions[beta > 0 ? 2 : beta < 0 ? 0 : 1][alpha > 0 ? 2 : alpha < 0 ? 0 : 1];
    const Long distance = distance_from_reference(problem, start, t);
    worst = larger(worst, distance);
    EXPECT_LE(distance, reference_units) << "alpha, beta, x, p, t = " << static_cast<double>(alpha) << ", "
                                         << static_cast<double>(beta) << ", " << static_cast<double>(x) << ", "
                                         << static_cast<double>(p) << ", " << static_cast<double>(t);
  }
  EXPECT_GT(motions[2][0], 50);
  EXPECT_GT(motions[2][1], 10);
  EXPECT_GT(motions[2][2], 50);
  EXPECT_GT(motions[0][2], 20);
  EXPECT_GT(motions[1][0] + motions[1][1] + motions[1][2], 20);
  RecordProperty("worst", std::to_string(static_cast<double>(worst)));
}

TEST(Duffing, ExactAtSpecialStarts) {
  const Duffing<Long> well(1, -1, 1);
  const Duffing<Long> soft(1, 1, -1);
  const Long root = std::sqrt(2.0L);
  for (const Long t : {0.0L, 1.0L, -4.0L, 20.0L}) {
    // Separatrices: x = sqrt 2 sech t, and x = sqrt(alpha/|beta|) tanh(sqrt(alpha/2) t).
    const auto loop = well.exact({-root}, {0}, t);
    EXPECT_TRUE(within(loop->q[0], -root / std::cosh(t), 64 * std::exp(std::fabs(t)) * long_epsilon));
    const auto front = Duffing<Long>(1, 4, -8).exact({0}, {1}, t);  // speed^2 = alpha^2/(2 |beta|), all exact
    ASSERT_TRUE(front.has_value());
    EXPECT_TRUE(within(front->q[0], std::tanh(root * t) / root, 8 * (1 + std::fabs(t)) * long_epsilon));
    EXPECT_EQ(well.exact({1}, {0}, t)->q[0], 1);
    EXPECT_EQ(well.exact({0}, {0}, t)->q[0], 0);
    EXPECT_EQ(soft.exact({-1}, {0}, t)->q[0], -1);
    EXPECT_EQ(soft.exact({0}, {0}, t)->p[0], 0);
  }
  EXPECT_FALSE(soft.exact({0}, {0.8L}, 1).has_value());
  EXPECT_FALSE(soft.exact({1.5L}, {0}, 1).has_value());
  EXPECT_FALSE(Duffing<Long>(1, -1, -1).exact({0.1L}, {0}, 1).has_value());
  // At rest and at the outer and inner turning points; small oscillations in the well; nearly linear springs.
  for (const Start1& start :
       {Start1{{1.3L}, {0}}, Start1{{-0.2L}, {0}}, Start1{{1 + 1e-8L}, {0}}, Start1{{2}, {0}}, Start1{{0}, {-1e-3L}},
        Start1{{1e-3L}, {0}}, Start1{{-1}, {1e-9L}}, Start1{{1e-5L}, {2e-5L}}, Start1{{-1e-5L}, {0.9e-5L}}}) {
    for (const Long t : {0.5L, -3.0L, 8.0L}) EXPECT_LE(distance_from_reference(well, start, t), reference_units);
  }
  for (const Long beta : {1e-12L, -1e-12L}) {
    EXPECT_LE(distance_from_reference(Duffing<Long>(1, 1, beta), Start1{{0.7L}, {0.4L}}, 6.0L), reference_units);
  }
}

TEST(Duffing, ExactLiesOnThePhaseCurve) {
  // (2.184) at the three figures. Either side has the size k r0^4.
  for (const Figure& figure : figures) {
    Parameters<Long> given(figure.problem);
    Duffing<Long>::derive(figure.kind, Parameters<Long>(figure.orbit), given);
    const Duffing<Long> problem(given);
    const Long mass = given["mass"];
    const Long k = given["k"];
    const Long lambda = given["lambda"];
    const Long lambda_inf = std::sqrt(2 * static_cast<Long>(figure.energy) / k);
    Long least = 4;
    for (Long t = -6; t <= 6; t += 0.13L) {
      const auto z = problem.exact({4}, {0}, t);
      const Long u = z->q[0] * z->q[0];
      EXPECT_TRUE(within(z->p[0] * z->p[0] / mass, -k * (u - (lambda - lambda_inf)) * (u - (lambda + lambda_inf)),
                         32 * long_epsilon * k * 256));
      least = std::min(least, z->q[0]);
    }
    EXPECT_EQ(least < 0, std::string(figure.kind) == "case1");
  }
}

TEST(Duffing, PeriodsAreCompleteIntegrals) {
  const Long amplitude = 1.7L;
  const auto returns = [&](const Duffing<Long>& problem, Long period, Long half) {
    const Long bound = 64 * (1 + 9 * period) * long_epsilon;
    const auto z = problem.exact({amplitude}, {0}, 9 * period);
    EXPECT_TRUE(within(z->q[0], amplitude, bound));
    EXPECT_TRUE(within(z->p[0], 0, bound));
    EXPECT_TRUE(within(problem.exact({amplitude}, {0}, period / 2)->q[0], half, bound));
  };
  const Long u = amplitude * amplitude;
  // Hard spring: 4 K(beta u/(2 (alpha + beta u)))/sqrt(alpha + beta u).
  returns(Duffing<Long>(1, 0.7L, 0.9L), 4 * complete_k(0.45L * u / (0.7L + 0.9L * u)) / std::sqrt(0.7L + 0.9L * u),
          -amplitude);
  // Soft spring: 4 K(m)/n, n^2 = alpha - |beta| u/2, m = |beta| u/(2 n^2).
  const Long n2 = 1.5L - 0.1L * u;
  returns(Duffing<Long>(1, 1.5L, -0.2L), 4 * complete_k(0.1L * u / n2) / std::sqrt(n2), -amplitude);
  // In one well, alpha = -2, beta = 1: 2 K(2 - 4/u)/(amplitude/sqrt 2), to the inner point sqrt(4 - u).
  returns(Duffing<Long>(1, -2, 1), 2 * complete_k(2 - 4 / u) / (amplitude / std::sqrt(2.0L)), std::sqrt(4 - u));
}

TEST(Duffing, TheCheckNoticesAWrongStiffness) {
  struct Slightly : Duffing<Long> {
    Slightly() : Duffing<Long>(1, -1, 1) {}
    std::optional<Start1> exact(const Vector<Long, 1>& q, const Vector<Long, 1>& p, Long t) const {
      return Duffing<Long>(1, -1, 1 + 1e-13L).exact(q, p, t);
    }
  };
  EXPECT_GT(distance_from_reference(Slightly(), Start1{{1.3L}, {0.1L}}, 3.0L), reference_units);
}

}  // namespace
}  // namespace hamflow
