// Formulas: what a text means, in every number type.
#include "hamflow/formula/formula.hpp"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../support/near.hpp"
#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"

namespace hamflow {
namespace {

const FormulaSymbols plane{.names = {"x", "y", "p_x", "p_y", "t"}};

/// At x = 0.3, y = -0.7, p_x = 1.1, p_y = 0.4, t = 2.
template <class S = double>
S value(const std::string& text) {
  const std::vector<S> at{S(0.3), S(-0.7), S(1.1), S(0.4), S(2)};
  return parse_formula(text, plane).evaluate<S>(at);
}

TEST(Formula, FollowsTheUsualRules) {
  const double x = 0.3;
  const double y = -0.7;
  EXPECT_EQ(value("x"), x);
  EXPECT_EQ(value(" 1 + 2 * 3 "), 7);
  EXPECT_EQ(value("x - y - 1"), x - y - 1);
  EXPECT_EQ(value("x/y/2"), x / y / 2);
  EXPECT_EQ(value("-x^2"), -(x * x));
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("2**3**2"), 512);
  EXPECT_EQ(value("x^-2"), 1 / (x * x));
  EXPECT_EQ(value("x^3"), x * x * x);
  EXPECT_EQ(value("x^0"), 1);
  EXPECT_EQ(value("x^0.5"), std::pow(x, 0.5));
  EXPECT_EQ(value("p_x^y"), std::pow(1.1, y));
  EXPECT_EQ(value("--x"), x);
  EXPECT_EQ(value("2*pi*x"), 2 * 3.14159265358979323846 * x);
  EXPECT_EQ(value("Pi"), 3.14159265358979323846);
  EXPECT_EQ(value("t*x"), 2 * x);
  EXPECT_EQ(value("sqrt(x) + exp(x) + log(x)"), std::sqrt(x) + std::exp(x) + std::log(x));
  EXPECT_EQ(value("sin(x) + cos(x) + tan(x)"), std::sin(x) + std::cos(x) + std::tan(x));
  EXPECT_EQ(value("asin(x) + acos(x) + atan(x)"), std::asin(x) + std::acos(x) + std::atan(x));
  EXPECT_EQ(value("sinh(x) + cosh(x) + tanh(x) + abs(y)"), std::sinh(x) + std::cosh(x) + std::tanh(x) + 0.7);
  EXPECT_EQ(value("atan2(y, x)"), std::atan2(y, x));
  EXPECT_EQ(value("1e2*x\n + y"), 1e2 * x + y);
}

TEST(Formula, SharesByLet) {
  EXPECT_EQ(value("let r = sqrt(x^2 + y^2), u = 1/r in u + r*u"), [] {
    const double r = std::sqrt(0.3 * 0.3 + 0.7 * 0.7);
    return 1 / r + r * (1 / r);
  }());
  EXPECT_EQ(value("2*(let a = x in a + a)"), 2 * (0.3 + 0.3));
  const Formula shared = parse_formula("let r = sqrt(x^2 + y^2) in r + 1/r", plane);
  const Formula twice = parse_formula("sqrt(x^2 + y^2) + 1/sqrt(x^2 + y^2)", plane);
  EXPECT_EQ(shared.graph().size(), twice.graph().size());  // what is equal is one node anyway
}

TEST(Formula, SumsOverIndices) {
  const FormulaSymbols chain{.names = {"x[1]", "x[2]", "x[3]", "n", "m[1]", "m[2]", "m[3]"},
                             .known = {{"n", 3}, {"m[1]", 1}, {"m[2]", 3}, {"m[3]", 2}}};
  const std::vector<double> at{0.5, 2, 3.25, 3, 1, 3, 2};
  const auto of = [&](const std::string& text) { return parse_formula(text, chain).evaluate<double>(at); };
  EXPECT_EQ(of("sum(i, 1, n - 1, (x[i+1] - x[i])^2)"), 1.5 * 1.5 + 1.25 * 1.25);
  EXPECT_EQ(of("sum(i, 1, n, i*x[i])"), 0.5 + 4 + 9.75);
  EXPECT_EQ(of("sum(i, 1, n, sum(j, i + 1, n, x[i]*x[j]))"), 0.5 * 2 + 0.5 * 3.25 + 2 * 3.25);
  EXPECT_EQ(of("sum(i, -1, 1, i)"), 0);
  EXPECT_EQ(of("sum(i, 2, 1, x[i])"), 0);
  EXPECT_EQ(of("x[m[2]] + x[2*n/3] + x[n^0]"), 3.25 + 2 + 0.5);
  EXPECT_EQ(of("sum(i, 1, n, m[i]*x[i])"), 0.5 + 6 + 6.5);
}

TEST(Formula, NamesKeysOfScenarios) {
  const FormulaSymbols keys{.names = {"problem.initial.q[1]", "run.dt", "problem.bodies[0].position[2]"}};
  const std::vector<double> at{0.25, 0.1, 7};
  const Formula f =
      parse_formula("sqrt(2*0.125 - problem.initial.q[1]^2) + run.dt*problem.bodies[0].position[2]", keys);
  EXPECT_EQ(f.evaluate<double>(at), std::sqrt(2 * 0.125 - 0.25 * 0.25) + 0.1 * 7);
}

/// In every number type to its own digits: constants are read in it.
TEST(Formula, HasTheDigitsOfItsNumbers) {
  const std::string text = "(x^2 + 0.1)*sin(y)/3 + atan2(y, x) + pi*sqrt(p_x)";
  const auto in_long = value<long double>(text);
  EXPECT_NEAR(value(text), static_cast<double>(in_long), 8e-16);
  EXPECT_NE(in_long, static_cast<long double>(value(text)));
  const Quad in_quad = value<Quad>(text);
  EXPECT_NEAR(static_cast<double>(static_cast<long double>(in_quad) - in_long), 0, 8 * 1.1e-19);
  EXPECT_LT(abs(static_cast<Quad>(value<DoubleDouble>(text).value.x[0]) + Quad(value<DoubleDouble>(text).value.x[1]) -
                in_quad),
            Quad(1e-30));
  const MpDigits digits(50);
  EXPECT_NEAR(static_cast<double>(value<Mp>(text)), static_cast<double>(in_long), 8e-16);
}

TEST(Formula, DifferentiatesByDualNumbers) {
  using D = Dual<double, 2>;
  const std::vector<D> at{D::variable(0.3, 0), D::variable(-0.7, 1), D(1.1), D(0.4), D(2)};
  const D f = parse_formula("atan2(y, x) + asin(x) + acos(y/2) + x^3 + p_x^x + x^t", plane).evaluate<D>(at);
  const double u = 0.58;
  EXPECT_NEAR(f.slope[0], 0.7 / u + 1 / std::sqrt(1 - 0.09) + 3 * 0.09 + std::log(1.1) * std::pow(1.1, 0.3) + 2 * 0.3,
              1e-14);
  EXPECT_NEAR(f.slope[1], 0.3 / u - 0.5 / std::sqrt(1 - 0.35 * 0.35), 1e-14);
}

TEST(Formula, KnowsWhatItUses) {
  const Formula f = parse_formula("x*t", plane);
  EXPECT_TRUE(f.uses(0));
  EXPECT_FALSE(f.uses(1));
  EXPECT_TRUE(f.uses(4));
}

std::string complaint(const std::string& text, const FormulaSymbols& symbols = plane) {
  return test::message_of<Error>([&] { (void)parse_formula(text, symbols); });
}

TEST(Formula, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(complaint("2pi"),
            "found \"2pi\", column 2: no operator before pi; allowed an operator (+ - * / ^); did you mean 2*pi?");
  EXPECT_EQ(complaint("x/(2 - 2)"),
            "found \"x/(2 - 2)\", column 2: x divided by (2 - 2), which is 0; allowed a divisor other than 0");
  EXPECT_EQ(complaint("9^9^9^9"),
            "found \"9^9^9^9\", column 4: 9^9^9 is infinite or too large; allowed finite real numbers");
  EXPECT_EQ(complaint("k*x"),
            "found \"k*x\", column 1: the unknown symbol k; allowed x, y, p_x, p_y, t, numbers, pi, functions such as "
            "sqrt(2)");
  EXPECT_EQ(complaint("x + p_z"),
            "found \"x + p_z\", column 5: the unknown symbol p_z; allowed x, y, p_x, p_y, t, numbers, pi, functions "
            "such as sqrt(2); did you mean p_x?");
  EXPECT_EQ(complaint("sqr(x)"),
            "found \"sqr(x)\", column 1: the unknown function sqr; allowed sum, sqrt, exp, log, sin, cos, tan, asin, "
            "acos, atan, atan2, sinh, cosh, tanh, abs; did you mean x^2, or sqrt(x)?");
  EXPECT_EQ(complaint("x(1 + y)"),
            "found \"x(1 + y)\", column 2: no operator between x and '('; allowed an operator (+ - * / ^); did you "
            "mean x*(1 + y)?");
  EXPECT_EQ(complaint("let sin = 1 in x"),
            "found \"let sin = 1 in x\", column 5: the name sin, which is a function; allowed another name");
  EXPECT_EQ(complaint("x[1]"), "found \"x[1]\", column 1: an index after x, which is one number; allowed x");
  const FormulaSymbols chain{.names = {"x[1]", "x[2]", "x[3]", "k"}, .known = {{"k", 0.5}}};
  EXPECT_EQ(complaint("x[4]", chain), "found \"x[4]\", column 1: there is no x[4]; allowed x[1] to x[3]");
  EXPECT_EQ(complaint("x", chain), "found \"x\", column 1: x without an index; allowed x[1] to x[3]");
  EXPECT_EQ(complaint("x[k]", chain), "found \"x[k]\", column 3: k, which is 0.5 and not whole; allowed whole numbers");
  EXPECT_EQ(complaint("sum(i, 1, 1e9, x[1]*i)", chain).find("found \"sum(i, 1, 1e9, x[1]*i)\", column "), 0u);
}

/// Wrong texts with their messages, each with a column; none of them takes the program down.
TEST(Formula, RefusesWrongTexts) {
  const FormulaSymbols symbols{.names = {"x", "y", "p_x", "p_y", "t", "k", "n", "m[1]", "m[2]", "q.a[0]"},
                               .known = {{"k", 0.5}, {"n", 3}, {"m[1]", 1}, {"m[2]", 2}}};
  std::ifstream file(std::string(HAMFLOW_TEST_DATA) + "/wrong_formulas.json");
  const auto all = nlohmann::json::parse(file);
  EXPECT_GE(all.size(), 300U);
  for (const auto& wrong : all) {
    const auto message = wrong.at("message").get<std::string>();
    EXPECT_EQ(complaint(wrong.at("text").get<std::string>(), symbols), message);
    EXPECT_NE(message.find(", column "), std::string::npos);
    EXPECT_NE(message.find("; allowed "), std::string::npos);
  }
}

TEST(Formula, HasLimits) {
  const auto many = [](int count, const std::string& text) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
  };
  const auto says = [](const std::string& text, const std::string& what) {
    const std::string message = complaint(text);
    EXPECT_NE(message.find(what), std::string::npos) << message;
  };
  says(many(300, "(") + "x" + many(300, ")"), "more than 200 nested");
  says(many(300, "-") + "x", "more than 200 nested");
  says(many(300, "sin(") + "x" + many(300, ")"), "more than 200 nested");
  says(many(300, "x^") + "2", "more than 200 nested");
  says(many(60000, "x+") + "x", "more than 10^5 characters");
  EXPECT_EQ(parse_formula(many(20000, "x+") + "x", plane).symbols().size(), 1U);  // long is not deep
}

/// What libFuzzer found worth keeping (./dev fuzz): each is read, or refused with a column.
TEST(Formula, ReadsTheCorpusOfTheFuzzer) {
  const FormulaSymbols symbols{.names = {"x", "y", "p_x", "p_y", "t", "k", "n", "m[1]", "m[2]", "q.a[0]"},
                               .known = {{"k", 0.5}, {"n", 3}, {"m[1]", 1}, {"m[2]", 2}}};
  int read = 0;
  int refused = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(HAMFLOW_TEST_DATA) + "/../fuzz/corpus")) {
    std::ifstream file(entry.path());
    std::stringstream text;
    text << file.rdbuf();
    const std::string message = complaint(text.str(), symbols);
    if (message == "nothing thrown") {
      ++read;
      continue;
    }
    ++refused;
    EXPECT_NE(message.find(", column "), std::string::npos) << message;
  }
  EXPECT_GT(read, 10);
  EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace hamflow
