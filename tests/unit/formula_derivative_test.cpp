// Exact derivatives of typed Hamiltonians: against dual numbers on random expressions, and what is found of a
// structure.
#include <random>

#include "../support/near.hpp"
#include "hamflow/detail/formula/bound_model.hpp"

namespace hamflow {
namespace {

using Long = long double;

/// Expressions of x, y, p_x, p_y, k whose values and derivatives stay moderate for arguments of size 1.
class RandomExpression {
 public:
  explicit RandomExpression(std::uint64_t seed) : random_(seed) {}

  std::string text(int depth) {
    if (depth == 0) return leaf();
    const std::string a = text(depth - 1);
    switch (pick(19)) {
      case 0:
      case 1:
        return "(" + a + " + " + text(depth - 1) + ")";
      case 2:
        return "(" + a + " - " + text(depth - 1) + ")";
      case 3:
      case 4:
        return "sin(" + a + ")*" + text(depth - 1);
      case 5:
        return a + "/(3 + cos(" + text(depth - 1) + "))";
      case 6:
        return "-sin(" + a + ")";
      case 7:
        return "cos(" + a + ")^3";
      case 8:
        return "sqrt(2 + tanh(" + a + "))";
      case 9:
        return "log(4 + sin(" + a + "))";
      case 10:
        return "exp(cos(" + a + "))";
      case 11:
        return "(2 + sin(" + a + "))^(-3/2)";
      case 12:
        return "(2 + sin(" + a + "))^k";
      case 13:
        return "(3 + cos(" + a + "))^sin(" + text(depth - 1) + ")";
      case 14:
        return "atan2(" + a + ", 2 + sin(" + text(depth - 1) + "))";
      case 15:
        return "asin(sin(" + a + ")/2)";
      case 16:
        return "acos(cos(" + a + ")/2) + atan(" + text(depth - 1) + ")";
      case 17:
        return "(let u = tan(sin(" + a + ")/2) in u^2 - abs(2 + u)*k)";
      default:
        return "(sinh(sin(" + a + ")) + cosh(cos(" + text(depth - 1) + "))/3)";
    }
  }
  Long number() { return std::uniform_real_distribution<double>(-1, 1)(random_); }

 private:
  int pick(int count) { return static_cast<int>(random_() % static_cast<std::uint64_t>(count)); }
  std::string leaf() {
    static const std::vector<std::string> all{"x",   "y", "p_x", "p_y",   "x",  "p_x", "k",
                                              "0.3", "2", "x^2", "p_y^3", "pi", "-y",  "x*p_x"};
    return all[static_cast<std::size_t>(pick(static_cast<int>(all.size())))];
  }
  std::mt19937_64 random_;
};

/// Rounding in long double is 1e-19; expressions of depth 4 lose a few digits of it, a wrong derivative all of them.
constexpr Long close = 1e-14L;

TEST(FormulaDerivatives, AreThoseOfDualNumbers) {
  using D = Dual<Long, 4>;
  using D2 = Dual<D, 4>;
  int separable = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    RandomExpression random(seed);
    FormulaTexts texts{.coordinates = {"x", "y"}, .parameters = {{"k", "1.7"}}};
    texts.hamiltonian = random.text(1 + static_cast<int>(seed % 4)) + " + p_x^2/2 + x*y";
    const auto model = std::make_shared<const formula::Model>(texts);
    separable += model->structure().separable;
    const formula::BoundModel<Long> bound(model, Parameters<Long>(texts.parameters));
    const Formula typed = parse_formula(texts.hamiltonian, model->symbols());
    Vector<Long, dynamic> q{random.number(), random.number()};
    Vector<Long, dynamic> p{random.number(), random.number()};
    std::vector<D2> at;
    for (std::size_t k = 0; k < 4; ++k) {
      at.push_back(D2::variable(D::variable(k < 2 ? q[k] : p[k - 2], k), k));
    }
    at.emplace_back(D(0));
    at.emplace_back(D(1.7L));
    const D2 expected = typed.evaluate<D2>(at);
    ASSERT_TRUE(test::within(bound.energy(q, p), expected.value.value, close * (1 + std::fabs(expected.value.value))))
        << texts.hamiltonian;
    Vector<Long, dynamic> dq(2);
    Vector<Long, dynamic> dp(2);
    bound.gradient(q, p, dq, dp);
    Matrix<Long, dynamic> qq(2);
    Matrix<Long, dynamic> qp(2);
    Matrix<Long, dynamic> pp(2);
    bound.hessian(q, p, qq, qp, pp);
    for (std::size_t i = 0; i < 4; ++i) {
      const Long first = expected.slope[i].value;
      ASSERT_TRUE(test::within(i < 2 ? dq[i] : dp[i - 2], first, close * (1 + std::fabs(first)))) << texts.hamiltonian;
      for (std::size_t j = 0; j < 4; ++j) {
        const Long second = expected.slope[i].slope[j];
        const Long found = i < 2 ? (j < 2 ? qq[i][j] : qp[i][j - 2]) : j < 2 ? qp[j][i - 2] : pp[i - 2][j - 2];
        ASSERT_TRUE(test::within(found, second, close * (1 + std::fabs(second)))) << texts.hamiltonian;
      }
    }
    if (model->structure().separable) {
      Vector<Long, dynamic> f(2);
      Vector<Long, dynamic> v(2);
      bound.force_and_hessian(q, f, pp);
      bound.velocity(p, v);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE(test::within(-f[i], dq[i], close * (1 + std::fabs(dq[i]))));
        EXPECT_TRUE(test::within(v[i], dp[i], close * (1 + std::fabs(dp[i]))));
        for (std::size_t j = 0; j < 2; ++j)
          EXPECT_TRUE(test::within(pp[i][j], qq[i][j], close * (1 + std::fabs(qq[i][j]))));
      }
    }
  }
  EXPECT_GT(separable, 20);
}

FormulaStructure structure(const std::string& hamiltonian) {
  return formula::Model({.coordinates = {"x", "y"}, .hamiltonian = hamiltonian, .parameters = {{"m", "2"}, {"k", "3"}}})
      .structure();
}

TEST(FormulaStructure, IsFoundFromTheExpression) {
  const auto natural = structure("(p_x^2 + p_y^2)/(2*m) + k/sqrt(x^2 + y^2)");
  EXPECT_TRUE(natural.separable && natural.quadratic_kinetic && !natural.time);
  EXPECT_TRUE(structure("k*(p_x^2/m + x^2)/2 + (p_y^2 + p_x*p_y + y^4)").quadratic_kinetic);
  EXPECT_TRUE(structure("(p_x^2 + p_y^2 + x^2 + y^2)/2").quadratic_kinetic);
  for (const std::string cross :
       {"(p_x^2 + p_x*p_y + p_y^2)/2", "0.5*(p_x^2 + p_x*p_y + p_y^2)", "(p_x*p_x + p_x*p_y + p_y*p_y)/2",
        "((p_x + p_y)^2 + p_x^2)/6", "k*(p_x*(2*p_x + m*p_y) + p_y^2)", "m*p_x^2 + k*p_x^2 + (p_y - p_x)^2"}) {
    EXPECT_TRUE(structure(cross + " + x^2*y").quadratic_kinetic) << cross;
    EXPECT_FALSE(structure(cross + " + (p_x + p_y)/2 + x^2*y").quadratic_kinetic) << cross;
    EXPECT_FALSE(structure(cross + " + p_x^3 + x^2*y").quadratic_kinetic) << cross;
  }
  EXPECT_FALSE(structure("(p_x^2 + p_x*p_y + p_y^2)*(1 + x^2)/2").quadratic_kinetic);
  const auto relativistic = structure("sqrt(1 + p_x^2 + p_y^2) + x^2 + y^2");
  EXPECT_TRUE(relativistic.separable && !relativistic.quadratic_kinetic);
  EXPECT_FALSE(structure("(p_x^2 + p_y^2)/2 + p_x + x*y").quadratic_kinetic);  // a linear term
  EXPECT_FALSE(structure("p_x^2/2 + x*y").quadratic_kinetic);                  // M is singular
  EXPECT_TRUE(structure("p_x^2/2 + x*y").separable);
  EXPECT_FALSE(structure("(p_x^2 + p_y^2)/2 + x*p_y - y*p_x").separable);
  EXPECT_FALSE(structure("p_x^2/(2*x) + p_y^2/2").separable);
  const auto driven = structure("(p_x^2 + p_y^2)/2 + x*cos(t)");
  EXPECT_TRUE(driven.time && driven.separable && driven.quadratic_kinetic);
  EXPECT_FALSE(structure("p_x^2*cos(t)/2 + p_y^2/2 + x*y").quadratic_kinetic);  // M is not constant
  EXPECT_FALSE(structure("p_x^2/2 + x*y*cos(t)").quadratic_kinetic);            // M is singular
}

/// The time since the step began and the beginning of the step come last, H + E is the energy: t' = 1, E' = -dH/dt.
TEST(FormulaStructure, CarriesTheTime) {
  const auto model = std::make_shared<const formula::Model>(
      FormulaTexts{.coordinates = {"x"}, .hamiltonian = "p_x^2/2 + k*x*cos(3*t)", .parameters = {{"k", "0.5"}}});
  EXPECT_EQ(model->size(), 1U);
  EXPECT_EQ(model->degrees(), 3U);
  const formula::BoundModel<double> bound(model, Parameters<double>(Texts{{"k", "0.5"}}));
  const Vector<double, dynamic> q{0.7, 0.05, 0.15};
  const Vector<double, dynamic> p{0.3, 1.1, 0};
  Vector<double, dynamic> f(3);
  Vector<double, dynamic> v(3);
  bound.force(q, f);
  bound.velocity(p, v);
  EXPECT_NEAR(bound.energy(q, p), 0.045 + 0.35 * std::cos(0.6) + 1.1, 1e-15);
  EXPECT_NEAR(f[0], -0.5 * std::cos(0.6), 1e-15);
  EXPECT_NEAR(f[1], 1.5 * 0.7 * std::sin(0.6), 1e-15);
  EXPECT_EQ(v[0], 0.3);
  EXPECT_EQ(v[1], 1);
  EXPECT_EQ(f[2], f[1]);  // t is the sum of both
  EXPECT_EQ(v[2], 0);
  EXPECT_FALSE(formula::Model({.coordinates = {"x"}, .hamiltonian = "p_x^2*(2 + cos(t))"}).structure().separable);
}

TEST(FormulaStructure, WritesCoordinatesOut) {
  const formula::Model chain({.coordinates = {"x[n]"},
                              .hamiltonian = "sum(i, 1, n, p_x[i]^2/(2*m[i])) + sum(i, 1, n - 1, exp(x[i] - x[i+1]))",
                              .parameters = {{"n", "3"}, {"m", "[1, 2, 3]"}},
                              .invariants = {{"momentum", "sum(i, 1, n, p_x[i])"}}});
  EXPECT_EQ(chain.coordinates(), (std::vector<std::string>{"x[1]", "x[2]", "x[3]"}));
  EXPECT_EQ(chain.momenta(), (std::vector<std::string>{"p_x[1]", "p_x[2]", "p_x[3]"}));
  EXPECT_TRUE(chain.structure().quadratic_kinetic);
  EXPECT_EQ(chain.symbols().known.size(), 1U);  // n, which the sums need, not m
}

std::string complaint(const FormulaTexts& texts) {
  try {
    (void)formula_choices(texts);
  } catch (const FormulaError& error) {
    return error.key + ": " + error.what();
  }
  return "nothing thrown";
}

TEST(FormulaTexts, AreCheckedByKey) {
  EXPECT_EQ(complaint({}), "coordinates: missing; allowed one or more, such as [\"x\", \"y\"]");
  EXPECT_EQ(complaint({.coordinates = {"x"}}), "hamiltonian: missing; allowed hamiltonian, or kinetic and potential");
  EXPECT_EQ(complaint({.coordinates = {"x"}, .kinetic = "p_x^2"}),
            "potential: missing; allowed hamiltonian, or kinetic and potential");
  EXPECT_EQ(complaint({.coordinates = {"x"}, .hamiltonian = "p_x^2", .potential = "x"}),
            "hamiltonian: found together with potential; allowed hamiltonian, or kinetic and potential");
  EXPECT_EQ(complaint({.coordinates = {"x"}, .kinetic = "p_x^2 + x", .potential = "x"}),
            "kinetic: found x in it; allowed momenta, parameters and t; otherwise give hamiltonian");
  EXPECT_EQ(complaint({.coordinates = {"sin"}, .hamiltonian = "1"}),
            "coordinates[0]: found the name sin, which is a function; allowed another name");
  EXPECT_EQ(complaint({.coordinates = {"x", "x"}, .hamiltonian = "1"}),
            "coordinates[1]: found the name x a second time; allowed names that differ");
  EXPECT_EQ(complaint({.coordinates = {"x"}, .momenta = {"p", "r"}, .hamiltonian = "1"}),
            "momenta: found 2; allowed as many as coordinates, 1");
  EXPECT_EQ(complaint({.coordinates = {"x[n]"}, .hamiltonian = "1"}).substr(0, 22), "coordinates[0]: found ");
  EXPECT_EQ(complaint({.coordinates = {"x[n]"}, .hamiltonian = "1", .parameters = {{"n", "2.5"}}}),
            "coordinates[0]: found \"x[n]\" with 2.5; allowed a whole number of coordinates from 1 to 10000");
  EXPECT_EQ(complaint({.coordinates = {"x"}, .hamiltonian = "p_x^2/(2*m)", .parameters = {{"m", "0"}}}),
            "hamiltonian: found \"p_x^2/(2*m)\", column 6: p_x^2 divided by (2*m), which is 0; allowed a divisor other "
            "than 0");
  EXPECT_EQ(complaint({.coordinates = {"x"}, .hamiltonian = "p_x^2", .invariants = {{"L", "x*p"}}}).substr(0, 21),
            "invariants.L: found \"");
}

/// Values that no index needs do not choose the problem.
TEST(FormulaTexts, ChooseWithoutValues) {
  FormulaTexts texts{.coordinates = {"x[n]"}, .hamiltonian = "sum(i, 1, n, p_x[i]^2/(2*m[i]) + k*x[i]^2)"};
  texts.parameters = {{"n", "2"}, {"k", "1/3"}, {"m", "[1, 2]"}};
  const Choices choices = formula_choices(texts);
  EXPECT_EQ(choices.at("parameters"), "k = ?; m = [?, ?]; n = 2");
  texts.parameters["k"] = "7";
  EXPECT_EQ(formula_choices(texts), choices);
  texts.parameters = formula_texts(choices).parameters;
  EXPECT_EQ(formula_choices(texts), choices);
}

TEST(FormulaTexts, OfAHamiltonianAlone) {
  const FormulaTexts plane =
      texts_of_hamiltonian("(p_x^2 + p_y^2)/(2*m) - k/sqrt(x^2 + y^2)", {{"m", "1"}, {"k", "1"}});
  EXPECT_EQ(plane.coordinates, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(plane.momenta, (std::vector<std::string>{"p_x", "p_y"}));
  EXPECT_EQ(texts_of_hamiltonian("p^2/2 - cos(q)").coordinates, (std::vector<std::string>{"q"}));
  EXPECT_EQ(texts_of_hamiltonian("q2 + p1^2 + p2^2").coordinates, (std::vector<std::string>{"q2", "q1"}));
}

}  // namespace
}  // namespace hamflow
