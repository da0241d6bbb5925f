// Number expressions, and the integer clock that keeps time.
#include "hamflow/core/number.hpp"

#include "../support/near.hpp"
#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/detail/core/step_clock.hpp"

namespace hamflow {
namespace {

double number(const char* text) { return evaluate_number<double>(text); }

TEST(Number, FollowsTheUsualRules) {
  EXPECT_EQ(number("0.1"), 0.1);
  EXPECT_EQ(number("1/3"), 1.0 / 3.0);
  EXPECT_EQ(number("2*pi/100"), 2 * 3.14159265358979323846 / 100);
  EXPECT_EQ(number("Pi"), 3.14159265358979323846);
  EXPECT_EQ(number(" 1 + 2 * 3 "), 7);
  EXPECT_EQ(number("(1+2)*3"), 9);
  EXPECT_EQ(number("1-2-3"), -4);
  EXPECT_EQ(number("8/2/2"), 2);
  EXPECT_EQ(number("1.5e-3"), 1.5e-3);
  EXPECT_EQ(number("2E2"), 200);
  EXPECT_EQ(number(".5"), 0.5);
  EXPECT_EQ(number("5."), 5);
  EXPECT_EQ(number("--2"), 2);
  EXPECT_EQ(number("+-+2"), -2);
  EXPECT_EQ(number("sqrt(2)"), std::sqrt(2.0));
  EXPECT_EQ(number("exp(1)"), std::exp(1.0));
  EXPECT_EQ(number("log(10)"), std::log(10.0));
  EXPECT_EQ(number("sin(1)+cos(1)"), std::sin(1.0) + std::cos(1.0));
  EXPECT_EQ(number("tan(1)+asin(1)+acos(0.5)+atan(2)"),
            std::tan(1.0) + std::asin(1.0) + std::acos(0.5) + std::atan(2.0));
  EXPECT_EQ(number("sinh(1)+cosh(1)+tanh(1)+abs(-3)"), std::sinh(1.0) + std::cosh(1.0) + std::tanh(1.0) + 3);
  EXPECT_EQ(number("atan2(-1, -2)"), std::atan2(-1.0, -2.0));
}

TEST(Number, PowersBindTighterThanSignsAndToTheRight) {
  EXPECT_EQ(number("2^3^2"), 512);
  EXPECT_EQ(number("2**3**2"), 512);
  EXPECT_EQ(number("-2^2"), -4);
  EXPECT_EQ(number("2^-3"), 0.125);
  EXPECT_EQ(number("2*3^2"), 18);
  EXPECT_EQ(number("2^3*2"), 16);
  EXPECT_EQ(number("4**0.5"), 2);
  EXPECT_EQ(number("2 ** 3 * 4"), 32);
}

TEST(Number, IsReadInTheWorkingArithmetic) {
  EXPECT_EQ(evaluate_number<long double>("0.1"), 0.1L);
  EXPECT_NE(evaluate_number<long double>("0.1"), static_cast<long double>(0.1));
  EXPECT_EQ(evaluate_number<long double>("1/3"), 1.0L / 3.0L);
  EXPECT_EQ(evaluate_number<long double>("pi"), 3.14159265358979323846264338327950288L);
}

/// A literal that stands alone is read without the formula around it.
TEST(Number, ALoneLiteralHasTheBitsThatItHasInAFormula) {
  for (const std::string text :
       {"0", "-0", "7", "5.", "-5.", "0.1", "-0.1", "1e5", "1E+5", "2.5e-3", "-2.5e-310", "5e-324", "1e-400",
        "1.7976931348623157e308", "9007199254740993", "0.31356843771250245879434867132452341234512345"}) {
    const double alone = evaluate_number<double>(text);
    const double inside = evaluate_number<double>("(" + text + ")");
    EXPECT_EQ(alone, inside) << text;
    EXPECT_EQ(std::signbit(alone), std::signbit(inside)) << text;
    EXPECT_EQ(evaluate_number<Quad>(text), evaluate_number<Quad>("(" + text + ")")) << text;
  }
  for (const std::string text : {"1e", "1e+", "1.5.2", "1 2", "-", "", "1e999", "-1e999"}) {
    EXPECT_THROW((void)evaluate_number<double>(text), Error) << text;
  }
}

std::string complaint(const std::string& text) {
  return test::message_of<Error>([&] { (void)evaluate_number<double>(text); });
}
const std::string functions = "sqrt, exp, log, sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, abs";
const std::string operands = "a number, pi, a function such as sqrt(2), or '('";
const std::string operators = "an operator (+ - * / ^)";

struct Wrong {
  std::string text;
  int column;
  std::string what;
  std::string allowed;
  std::string meant = "";
};

TEST(Number, EveryErrorNamesItsColumnWhatIsWrongAndWhatIsAllowed) {
  const std::string symbols = "numbers, pi, functions such as sqrt(2)";
  const std::string decimal = "a decimal number such as 0.1";
  const std::string finite = "finite real numbers";
  const Wrong all[] = {
      // a number is missing
      {"", 1, "a number is missing before the end", operands},
      {"  ", 3, "a number is missing before the end", operands},
      {"1 +", 4, "a number is missing before the end", operands},
      {"2 ^ ", 5, "a number is missing before the end", operands},
      {"3 * * 2", 5, "a number is missing before '*'", operands},
      {"()", 2, "a number is missing before ')'", operands},
      {"sqrt()", 6, "a number is missing before ')'", operands},
      {"\"1\"", 1, "a number is missing before '\"'", operands},
      {"2*π", 3, "a number is missing before 'π'", operands},
      // an operator is missing
      {"2pi", 2, "no operator before pi", operators, "2*pi"},
      {"2 pi", 3, "no operator before pi", operators, "2*pi"},
      {"1 + 2Pi/3", 6, "no operator before Pi", operators, "1 + 2*Pi/3"},
      {"2sqrt(3)", 2, "no operator before sqrt", operators, "2*sqrt(3)"},
      {"2(3 + 4)", 2, "no operator before (", operators, "2*(3 + 4)"},
      {"(1)(2)", 4, "no operator before (", operators, "(1)*(2)"},
      {"(2pi)", 3, "no operator before pi", operators, "(2*pi)"},
      {"pi 2", 4, "no operator before 2", operators, "pi*2"},
      {"1 000", 3, "no operator before 0", operators},
      {"2foo", 2, "no operator before foo", operators},
      {"2e", 2, "no operator before e", operators + ", or an exponent such as 2e-3"},
      {"0x10", 2, "no operator before x10", operators},
      {"1)", 2, "')' without its '('", operators + " or the end"},
      {"1,5", 2, "',' in a number", "a point before decimals", "1.5"},
      {"1;5", 2, "';' after a complete number", operators + " or the end"},
      {"(1;5)", 3, "';' after a complete number", operators + " or ')'"},
      {"π = 3", 1, "a number is missing before 'π'", operands},
      {"1 = 1", 3, "'=' after a complete number", operators + " or the end"},
      // parentheses
      {"(1", 3, "the end before the ')' of (1", "')'"},
      {"2*(1 + (3)", 11, "the end before the ')' of (1 + (3)", "')'"},
      {"sin(1", 6, "the end before the ')' of (1", "')'"},
      {"atan2(1", 8, "the end before the ')' of (1", "')'"},
      // names
      {"foo(3)", 1, "the unknown function foo", functions},  // nothing that is allowed is near it
      {"1 + sinus(2)", 5, "the unknown function sinus", functions, "sin"},
      {"integral(3)", 1, "the unknown function integral", functions},
      {"Sqrt(2)", 1, "the unknown function Sqrt", functions, "sqrt"},
      {"foo", 1, "the unknown symbol foo", symbols},
      {"2*x_1 + 1", 3, "the unknown symbol x_1", symbols},
      {"nan", 1, "the unknown symbol nan", symbols},
      {"inf", 1, "the unknown symbol inf", symbols},
      {"NaN", 1, "the unknown symbol NaN", symbols},
      {"2*PI", 3, "the unknown symbol PI", symbols, "pi"},
      {"p + 1", 1, "the unknown symbol p", symbols, "pi"},
      {"sqrt 2", 1, "the function sqrt without parentheses", "sqrt(x)"},
      {"1 - atan2", 5, "the function atan2 without parentheses", "atan2(y, x)"},
      {"atan2(1)", 8, "atan2 with one argument", "atan2(y, x)"},
      {"atan2(1, 2, 3)", 11, "atan2 with more than two arguments", "atan2(y, x)"},
      {"sin(1, 2)", 6, "sin with more than one argument", "sin(x)"},
      // literals
      {"1.2.3", 4, "a second point in a number", decimal},
      {".", 1, "'.' without digits", decimal},
      {"1 + .e5", 5, "'.' without digits", decimal},
      // division by zero
      {"2*pi/0", 5, "2*pi divided by 0", "a divisor other than 0"},
      {"1 + 2*pi/(3 - 3)", 9, "2*pi divided by (3 - 3), which is 0", "a divisor other than 0"},
      {"(1/0)", 3, "1 divided by 0", "a divisor other than 0"},
      {"0/0.0", 2, "0 divided by 0.0, which is 0", "a divisor other than 0"},
      {"(1 + 1) / 0 + 5", 9, "(1 + 1) divided by 0", "a divisor other than 0"},
      // what is not finite
      {"9^9^9^9", 4, "9^9^9 is infinite or too large", finite},
      {"1e999", 1, "1e999 is infinite or too large", finite},
      {"2 + exp(1000)", 5, "exp(1000) is infinite or too large", finite},
      {"0^-1", 2, "0^-1 is infinite or too large", finite},
      {"log(0)", 1, "log(0) is infinite or too large", finite},
      {"1 + log(-1)", 5, "log(-1) is not a real number", finite},
      {"sqrt(-1)", 1, "sqrt(-1) is not a real number", finite},
      {"(-8)^(1/3)", 5, "(-8)^(1/3) is not a real number", finite},
      {"acos(2)", 1, "acos(2) is not a real number", finite},
      {"1e308 * 10", 7, "1e308 * 10 is infinite or too large", finite},
  };
  for (const Wrong& wrong : all) {
    EXPECT_EQ(complaint(wrong.text), "found \"" + wrong.text + "\", column " + std::to_string(wrong.column) + ": " +
                                         wrong.what + "; allowed " + wrong.allowed +
                                         (wrong.meant.empty() ? "" : "; did you mean " + wrong.meant + "?"));
  }
}

TEST(Number, LengthNestingAndOperationsAreLimited) {
  const auto repeated = [](const std::string& part, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += part;
    return all;
  };
  const std::string too_deep = ": more than 200 nested signs, powers and parentheses; allowed at most 200";
  for (const char* opening : {"(", "-", "2^", "sqrt("}) {
    const std::string text = repeated(opening, 100'000) + "1";
    const std::size_t column = 200 * std::string(opening).size() + 1;
    EXPECT_NE(complaint(text).find(", column " + std::to_string(column) + too_deep), std::string::npos)
        << complaint(text);
  }
  EXPECT_EQ(number((repeated("(", 199) + "1" + repeated(")", 199)).c_str()), 1);
  EXPECT_EQ(number((repeated("1+", 5'000 - 1) + "1").c_str()), 5'000);
  EXPECT_NE(complaint(repeated("1+", 10'000) + "1").find(": more than 10^4 operations; allowed at most 10^4"),
            std::string::npos);
  EXPECT_NE(
      complaint(repeated("1", 1'000'001)).find(", column 1000001: more than 10^6 characters; allowed at most 10^6"),
      std::string::npos);
  // A long text is shown around the place that is meant, and no more of it.
  const std::string message = complaint(repeated("1+", 500) + "foo" + repeated("+1", 500));
  EXPECT_NE(message.find("1+foo+1"), std::string::npos) << message;
  EXPECT_NE(message.find("column 1001: the unknown symbol foo"), std::string::npos) << message;
  EXPECT_LT(message.size(), 200U);
}

/// The same texts in every arithmetic; what is too large depends on it.
template <class R>
void refuses_what_is_not_finite() {
  const auto message = [](const char* text) {
    return test::message_of<Error>([&] { (void)evaluate_number<R>(text); });
  };
  EXPECT_EQ(message("2*pi/0"), "found \"2*pi/0\", column 5: 2*pi divided by 0; allowed a divisor other than 0");
  EXPECT_EQ(message("1 + log(-1)"),
            "found \"1 + log(-1)\", column 5: log(-1) is not a real number; allowed finite real numbers");
  EXPECT_EQ(message("sqrt(-1)"),
            "found \"sqrt(-1)\", column 1: sqrt(-1) is not a real number; allowed finite real numbers");
  EXPECT_NE(message("9^9^9^9").find(" is infinite or too large; allowed finite real numbers"), std::string::npos)
      << message("9^9^9^9");
  EXPECT_NE(message("log(0)").find("column 1: log(0) is "), std::string::npos) << message("log(0)");
  EXPECT_EQ(evaluate_number<R>("2*3 - 8/4 + 2^3"), R(12));
}
TEST(Number, IsFiniteInEveryArithmetic) {
  refuses_what_is_not_finite<double>();
  refuses_what_is_not_finite<long double>();
  refuses_what_is_not_finite<DoubleDouble>();
  refuses_what_is_not_finite<Quad>();
  refuses_what_is_not_finite<Mp>();
  EXPECT_TRUE(evaluate_number<long double>("1e999") > 1e308L);  // too large for double only
}

TEST(Number, WholeNumbersMayBeFormulas) {
  EXPECT_EQ(evaluate_whole("1e6"), 1'000'000);
  EXPECT_EQ(evaluate_whole("10^6"), 1'000'000);
  EXPECT_EQ(evaluate_whole("2*500"), 1000);
  EXPECT_EQ(evaluate_whole(" -3 "), -3);
  EXPECT_EQ(evaluate_whole("6/3"), 2);
  EXPECT_EQ(evaluate_whole("1.5e1"), 15);
  std::int64_t ten = 1;
  for (int k = 0; k <= 15; ++k, ten *= 10) {
    EXPECT_EQ(evaluate_whole("10^" + std::to_string(k)), ten);
    EXPECT_EQ(evaluate_whole("1e" + std::to_string(k)), ten);
    EXPECT_EQ(evaluate_whole("1e" + std::to_string(k) + " + 1"), ten + 1);
  }
  for (int k = 0; k <= 53; ++k) EXPECT_EQ(evaluate_whole("2^" + std::to_string(k)), std::int64_t{1} << k);
  EXPECT_EQ(evaluate_whole("-9007199254740992"), -(std::int64_t{1} << 53));
  const auto message = [](const char* text) { return test::message_of<Error>([&] { (void)evaluate_whole(text); }); };
  const std::string allowed = "; allowed whole numbers from -2^53 to 2^53, such as 1000, 1e6 or 10^6";
  EXPECT_EQ(message("1/2"), "found \"1/2\", column 1: 0.5, which is not whole" + allowed);
  EXPECT_EQ(message("1000.5"), "found \"1000.5\", column 1: 1000.5, which is not whole" + allowed);
  EXPECT_EQ(message("2^53 + 1"), "found \"2^53 + 1\", column 1: a number beyond 2^53" + allowed);
  EXPECT_EQ(message("9007199254740993"), "found \"9007199254740993\", column 1: a number beyond 2^53" + allowed);
  EXPECT_EQ(message("1/0"), "found \"1/0\", column 2: 1 divided by 0; allowed a divisor other than 0");
  EXPECT_EQ(message("many"),
            "found \"many\", column 1: the unknown symbol many; allowed numbers, pi, functions such as "
            "sqrt(2)");
}

TEST(Number, ShortestDecimalReadsBackAsTheSameDouble) {
  for (const double x : {0.1, 1.0 / 3, 1e300, -2.5e-308, 5e-324, 123456789.125}) {
    EXPECT_EQ(std::strtod(shortest(x).c_str(), nullptr), x);
  }
  EXPECT_EQ(shortest(0.1), "0.1");
}

TEST(StepClock, TimeIsAWholeNumberOfStepsWithoutAccumulation) {
  StepClock<> clock(1.0, 0.1);
  for (int i = 0; i < 1000; ++i) clock.advance(1);
  EXPECT_EQ(clock.time(), 1.0 + 1000 * 0.1);
  double accumulated = 1.0;
  for (int i = 0; i < 1000; ++i) accumulated += 0.1;
  EXPECT_NE(accumulated, clock.time());  // what nobody writes
  EXPECT_EQ(clock.steps_taken(), 1000);
}

TEST(StepClock, GoingBackMeetsTheSameTimes) {
  StepClock<> clock(0.25, 0.1);
  std::vector<double> there;
  for (int i = 0; i < 50; ++i) {
    there.push_back(clock.time());
    clock.advance(1);
  }
  clock.reverse();
  EXPECT_EQ(clock.step_length(), -0.1);
  for (int i = 49; i >= 0; --i) {
    clock.advance(1);
    EXPECT_EQ(clock.time(), there[static_cast<std::size_t>(i)]);
  }
  EXPECT_EQ(clock.steps_taken(), 100);
}

}  // namespace
}  // namespace hamflow
