// Dual numbers against closed forms: value, first and, nested, second derivatives.
#include "hamflow/core/dual.hpp"

#include <functional>
#include <string>

#include "../support/near.hpp"

namespace hamflow {
namespace {

using D1 = Dual<double, 1>;
using D2 = Dual<D1, 1>;

struct Case {
  std::string name;
  std::function<D2(const D2&)> function;
  std::function<long double(long double)> value, first, second;
  std::vector<double> points;
};

using L = long double;

std::vector<Case> cases() {
  const auto one = [](L) { return 1.0L; };
  const auto zero = [](L) { return 0.0L; };
  return {
      {"sqrt",
       [](const D2& x) { return sqrt(x); },
       [](L x) { return std::sqrt(x); },
       [](L x) { return 0.5L / std::sqrt(x); },
       [](L x) { return -0.25L / (x * std::sqrt(x)); },
       {0.3, 2.0, 71.0}},
      {"exp",
       [](const D2& x) { return exp(x); },
       [](L x) { return std::exp(x); },
       [](L x) { return std::exp(x); },
       [](L x) { return std::exp(x); },
       {-1.5, 0.2, 3.0}},
      {"log",
       [](const D2& x) { return log(x); },
       [](L x) { return std::log(x); },
       [](L x) { return 1 / x; },
       [](L x) { return -1 / (x * x); },
       {0.4, 3.0}},
      {"sin",
       [](const D2& x) { return sin(x); },
       [](L x) { return std::sin(x); },
       [](L x) { return std::cos(x); },
       [](L x) { return -std::sin(x); },
       {-2.0, 0.7, 5.0}},
      {"cos",
       [](const D2& x) { return cos(x); },
       [](L x) { return std::cos(x); },
       [](L x) { return -std::sin(x); },
       [](L x) { return -std::cos(x); },
       {-2.0, 0.7, 5.0}},
      {"tan",
       [](const D2& x) { return tan(x); },
       [](L x) { return std::tan(x); },
       [](L x) { return 1 / (std::cos(x) * std::cos(x)); },
       [](L x) { return 2 * std::tan(x) / (std::cos(x) * std::cos(x)); },
       {-1.0, 0.4}},
      {"atan",
       [](const D2& x) { return atan(x); },
       [](L x) { return std::atan(x); },
       [](L x) { return 1 / (1 + x * x); },
       [](L x) { return -2 * x / ((1 + x * x) * (1 + x * x)); },
       {-3.0, 0.6}},
      {"sinh",
       [](const D2& x) { return sinh(x); },
       [](L x) { return std::sinh(x); },
       [](L x) { return std::cosh(x); },
       [](L x) { return std::sinh(x); },
       {-1.0, 2.0}},
      {"cosh",
       [](const D2& x) { return cosh(x); },
       [](L x) { return std::cosh(x); },
       [](L x) { return std::sinh(x); },
       [](L x) { return std::cosh(x); },
       {-1.0, 2.0}},
      {"tanh",
       [](const D2& x) { return tanh(x); },
       [](L x) { return std::tanh(x); },
       [](L x) { return 1 / (std::cosh(x) * std::cosh(x)); },
       [](L x) { return -2 * std::tanh(x) / (std::cosh(x) * std::cosh(x)); },
       {-0.8, 0.5}},
      {"abs",
       [](const D2& x) { return abs(x); },
       [](L x) { return std::fabs(x); },
       [](L x) { return x < 0 ? -1.0L : 1.0L; },
       zero,
       {-1.3, 0.9}},
      {"pow 2.5",
       [](const D2& x) { return pow(x, 2.5); },
       [](L x) { return std::pow(x, 2.5L); },
       [](L x) { return 2.5L * std::pow(x, 1.5L); },
       [](L x) { return 3.75L * std::pow(x, 0.5L); },
       {0.4, 3.0}},
      {"pow -6",
       [](const D2& x) { return pow(x, -6.0); },
       [](L x) { return std::pow(x, -6.0L); },
       [](L x) { return -6 * std::pow(x, -7.0L); },
       [](L x) { return 42 * std::pow(x, -8.0L); },
       {0.9, 1.5}},
      {"+x", [](const D2& x) { return x; }, [](L x) { return x; }, one, zero, {1.5}},
      {"3 - x", [](const D2& x) { return 3.0 - x; }, [](L x) { return 3 - x; }, [](L) { return -1.0L; }, zero, {1.5}},
      {"x - 3", [](const D2& x) { return x - 3; }, [](L x) { return x - 3; }, one, zero, {1.5}},
      {"2 x^2 + 1",
       [](const D2& x) { return 2 * x * x + 1.0; },
       [](L x) { return 2 * x * x + 1; },
       [](L x) { return 4 * x; },
       [](L) { return 4.0L; },
       {1.5}},
      {"1/x",
       [](const D2& x) { return 1.0 / x; },
       [](L x) { return 1 / x; },
       [](L x) { return -1 / (x * x); },
       [](L x) { return 2 / (x * x * x); },
       {-0.7, 1.5}},
      {"x/4", [](const D2& x) { return x / 4.0; }, [](L x) { return x / 4; }, [](L) { return 0.25L; }, zero, {1.5}},
      {"x/(1+x^2)",
       [](const D2& x) { return x / (1.0 + x * x); },
       [](L x) { return x / (1 + x * x); },
       [](L x) { return (1 - x * x) / ((1 + x * x) * (1 + x * x)); },
       [](L x) { return 2 * x * (x * x - 3) / std::pow(1 + x * x, 3.0L); },
       {-0.7, 2.5}},
      {"compound",
       [](const D2& x) {
         D2 y = x;
         y *= x;
         y += 1.0;
         y -= x;
         y /= x;
         return y;
       },
       [](L x) { return x + 1 / x - 1; },
       [](L x) { return 1 - 1 / (x * x); },
       [](L x) { return 2 / (x * x * x); },
       {0.6, 2.5}},
  };
}

TEST(Dual, ValueFirstAndSecondDerivativeAreTheClosedForms) {
  for (const Case& c : cases()) {
    for (const double at : c.points) {
      SCOPED_TRACE(c.name + " at " + std::to_string(at));
      const D2 x = D2::variable(D1::variable(at, 0), 0);
      const D2 y = c.function(x);
      // Each of a handful of operations rounds once; the terms are at most a few times the size of f, f' x or f'' x^2.
      const long double size = std::fabs(c.value(at)) + 1;
      const long double bound = 32 * test::epsilon * (size + std::fabs(c.first(at)) + std::fabs(c.second(at)));
      EXPECT_TRUE(test::within(y.value.value, c.value(at), bound));
      EXPECT_TRUE(test::within(y.value.slope[0], c.first(at), bound)) << "inner derivative";
      EXPECT_TRUE(test::within(y.slope[0].value, c.first(at), bound)) << "outer derivative";
      EXPECT_TRUE(test::within(y.slope[0].slope[0], c.second(at), bound)) << "second derivative";
    }
  }
}

TEST(Dual, CarriesEveryDirectionOfAFunctionOfTwoVariables) {
  // f = x y + sin(x) / y: f_x = y + cos(x)/y, f_y = x - sin(x)/y^2
  using D = Dual<double, 2>;
  const double a = 0.8;
  const double b = -1.7;
  const D x = D::variable(a, 0);
  const D y = D::variable(b, 1);
  const D f = x * y + sin(x) / y;
  EXPECT_TRUE(test::same_to_rounding(f.value, a * b + std::sin(a) / b, 4.0));
  EXPECT_TRUE(test::same_to_rounding(f.slope[0], b + std::cos(a) / b, 4.0));
  EXPECT_TRUE(test::same_to_rounding(f.slope[1], a - std::sin(a) / (b * b), 4.0));
}

TEST(Dual, MixedSecondDerivativeOfAProduct) {
  // f = x^2 y^3 at (2, 3): f_xx = 2 y^3 = 54, f_xy = 6 x y^2 = 108, f_yy = 6 x^2 y = 72; all exact in double.
  using Inner = Dual<double, 2>;
  using Outer = Dual<Inner, 2>;
  const Outer x = Outer::variable(Inner::variable(2.0, 0), 0);
  const Outer y = Outer::variable(Inner::variable(3.0, 1), 1);
  const Outer f = x * x * y * y * y;
  EXPECT_EQ(f.slope[0].slope[0], 54.0);
  EXPECT_EQ(f.slope[0].slope[1], 108.0);
  EXPECT_EQ(f.slope[1].slope[0], 108.0);
  EXPECT_EQ(f.slope[1].slope[1], 72.0);
}

TEST(Dual, ComparesByValueAndAConstantHasNoSlope) {
  const D1 small(1.0);
  const D1 large = D1::variable(2.0, 0);
  EXPECT_TRUE(small < large && large > small && small <= small);
  EXPECT_FALSE(large < small);
  EXPECT_EQ(D1(3).slope[0], 0.0);
  EXPECT_EQ(value_of(D2(D1(4.0))), 4.0);
}

}  // namespace
}  // namespace hamflow
