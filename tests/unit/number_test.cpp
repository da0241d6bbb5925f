// Number expressions, and the integer clock that keeps time.
#include "hamflow/core/number.hpp"

#include "../support/near.hpp"
#include "hamflow/core/step_clock.hpp"

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

struct Wrong {
  const char* text;
  int column;
  const char* expected;
};

TEST(Number, SaysInWhichColumnItStopsMakingSense) {
  const Wrong all[] = {
      {"", 1, "a number"},
      {"1 +", 4, "a number"},
      {"2 pi", 3, "an operator or the end"},
      {"(1", 3, "')'"},
      {"1)", 2, "an operator"},
      {"foo", 1, "a number"},
      {"nan", 1, "a number"},
      {"inf", 1, "a number"},
      {"NaN", 1, "a number"},
      {"2e", 2, "an operator"},
      {"1.2.3", 6, "a decimal"},
      {".", 2, "a decimal"},
      {"sqrt 2", 1, "a number, pi, a function such as sqrt(2)"},
      {"sin(1", 6, "')'"},
      {"3 * * 2", 5, "a number"},
      {"1 + sinus(2)", 5, "one of sqrt, exp"},
      {"atan2(1)", 8, "','"},
      {"0x10", 2, "an operator"},
      {"1,5", 2, "an operator"},
      {"2 ^ ", 5, "a number"},
  };
  for (const Wrong& wrong : all) {
    const std::string message = test::message_of<Error>([&] { (void)number(wrong.text); });
    EXPECT_NE(message.find("column " + std::to_string(wrong.column) + ":"), std::string::npos) << message;
    EXPECT_NE(message.find(std::string("expected ") + wrong.expected), std::string::npos) << message;
    EXPECT_NE(message.find("\"" + std::string(wrong.text) + "\""), std::string::npos) << message;
  }
}

TEST(Number, RefusesNestingThatWouldExhaustTheStack) {
  const std::string deep = std::string(100000, '(') + "1" + std::string(100000, ')');
  EXPECT_THROW((void)number(deep.c_str()), Error);
  EXPECT_THROW((void)number((std::string(100000, '-') + "1").c_str()), Error);
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
