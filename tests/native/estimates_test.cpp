// kernel = "fast": the powers that a recording estimates, their error, their bits, and what is left alone.
#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/core/inverse_cube.hpp"
#include "hamflow/core/tape.hpp"
#include "hamflow/run/recorded_step.hpp"
#include "random_program.hpp"

namespace hamflow {
namespace {

using I = Instruction;

/// (u, k, ., .) to (u, k, x, y): x = k/(u sqrt(u)) or k/sqrt(u) with estimates, y the same without.
Program power(bool is_cube) {
  Recorder<double> recorder(Folding::exact);
  const auto u = recorder.input(1.5), k = recorder.input(1);
  const auto quotient = [&] { return is_cube ? k / (u * sqrt(u)) : k / sqrt(u); };
  const auto exact = quotient();
  recorder.set_estimates(true);
  const auto fast = quotient();
  EXPECT_EQ(fast.value, is_cube ? inverse_cube(1.5) : inverse_root(1.5));
  EXPECT_TRUE(recorder.has_estimated());
  return program_of(recorder.finish({u, k, fast, exact}));
}

long double longer(double x) { return static_cast<long double>(x); }

/// The largest error in units of 2^-53, relative, and whether what is not estimated is exact.
std::pair<long double, bool> largest_error(bool is_cube, double factor, int lowest, int highest) {
  const auto loop = make_step_loop(power(is_cube));
  long double largest = 0;
  bool others_exact = true;
  Draw draw(3);
  for (int i = 0; i < 200000; ++i) {
    const int exponent = lowest + static_cast<int>(draw.below(static_cast<std::size_t>(highest - lowest + 1)));
    const double x = std::ldexp(1 + draw.uniform(), exponent);
    std::vector<double> z = {x, factor, 0, 0};
    EXPECT_TRUE(loop->run(z, 1));
    const long double root = std::sqrt(longer(x)), exact = longer(factor) / (is_cube ? longer(x) * root : root);
    largest = std::max(largest, std::fabs(longer(z[2]) - exact) / std::fabs(exact) * 0x1p53L);
    others_exact = others_exact && z[3] == factor / (is_cube ? x * std::sqrt(x) : std::sqrt(x));
  }
  return {largest, others_exact};
}

class Estimates : public testing::Test {
 protected:
  void SetUp() override {
    if (!fast_kernel_available()) GTEST_SKIP() << "this processor has no estimates";
  }
};

// y^3 is exact, so that only the last addition rounds for k = 1; for others k y^3 is rounded too.
TEST_F(Estimates, CubesAreRoundedOnce) {
  const auto [error, others_exact] = largest_error(true, 1, -681, 669);
  EXPECT_LT(error, 1.002);
  EXPECT_TRUE(others_exact);
  EXPECT_LT(largest_error(true, 1.7, -600, 600).first, 2.01);
}

TEST_F(Estimates, RootsAreRoundedOnce) {
  const auto [error, others_exact] = largest_error(false, 1, -1000, 1000);
  EXPECT_LT(error, 1.002);
  EXPECT_TRUE(others_exact);
  EXPECT_LT(largest_error(false, 1.7, -1000, 1000).first, 2.01);
}

TEST_F(Estimates, LoopAndInterpreterHaveTheBitsOfTheFunctions) {
  for (const bool is_cube : {false, true}) {
    for (const auto& loop : {make_step_loop(power(is_cube)), make_interpreter(power(is_cube))}) {
      Draw draw(4);
      for (int i = 0; i < 10000; ++i) {
        const double x = std::ldexp(1 + draw.uniform(), static_cast<int>(draw.below(100)) - 50);
        const double factor = draw.uniform();
        std::vector<double> z = {x, factor, 0, 0};
        EXPECT_TRUE(loop->run(z, 1));
        EXPECT_EQ(z[2], is_cube ? inverse_cube(x, factor) : inverse_root(x, factor));
      }
    }
  }
}

TEST_F(Estimates, NoRootAndNoDivisionIsLeft) {
  Recorder<double> recorder(Folding::exact);
  const auto u = recorder.input(2), k = recorder.input(1);
  recorder.set_estimates(true);
  const auto root = sqrt(u);
  const Program fast = program_of(recorder.finish({k / (u * root), k / (root * u) + 1.5 / root}));
  for (const auto& operation : fast.operations) {
    EXPECT_NE(operation.instruction, I::divide);
    EXPECT_NE(operation.instruction, I::square_root);
  }
}

TEST_F(Estimates, OtherQuotientsStay) {
  Recorder<double> recorder(Folding::exact);
  const auto u = recorder.input(2), v = recorder.input(3);
  recorder.set_estimates(true);
  const std::vector<Trace<double>> all{1 / u, u / (v * sqrt(u)), u / (v + sqrt(u)), sqrt(u) / v, u / 2.0};
  EXPECT_FALSE(recorder.has_estimated());
  const double a = 2, b = 3, expected[] = {1 / a, a / (b * std::sqrt(a)), a / (b + std::sqrt(a)), std::sqrt(a) / b, 1};
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].value, expected[i]);
  recorder.set_estimates(false);
  EXPECT_EQ((1 / sqrt(u)).value, 1 / std::sqrt(a));
  EXPECT_FALSE(recorder.has_estimated());
}

TEST_F(Estimates, NoNumberIsWrongWithoutLookingSo) {
  for (const bool is_cube : {false, true}) {
    const auto loop = make_step_loop(power(is_cube));
    for (const double x : {0.0, -0.0, 0x1p-1074, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
      std::vector<double> z = {x, 1, 0, 0};
      EXPECT_TRUE(loop->run(z, 1));
      EXPECT_FALSE(std::isfinite(z[2])) << x;
    }
  }
}

}  // namespace
}  // namespace hamflow
