// kernel = "fast" as a rewriting: its bits, its error, and what it leaves alone.
#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/numerics/inverse_cube.hpp"
#include "random_program.hpp"

namespace hamflow {
namespace {

using I = Instruction;
using K = Operand::Kind;

Operand result(std::uint32_t i) { return {K::result, i}; }
constexpr Operand u{K::carried, 0}, k{K::carried, 1};

/// (u, k, x, y): x <- k/(u sqrt(u)) or k/sqrt(u), which is state; y <- the same, which is not.
Program power(bool is_cube) {
  Program p;
  p.operations = {{I::square_root, u, {}}, {I::multiply, u, result(0)}, {I::divide, k, result(is_cube ? 1 : 0)}};
  p.outputs = {u, k, result(2), result(2)};
  return p;
}

long double longer(double x) { return static_cast<long double>(x); }

/// The largest error in units of 2^-53, relative, and that of what is not state.
std::pair<long double, bool> largest_error(bool is_cube, double factor, int lowest, int highest) {
  const auto loop = make_step_loop(with_estimates(power(is_cube), 3));
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

TEST_F(Estimates, CubesHaveTheBitsOfTheTypedKernel) {
  for (const auto& loop :
       {make_step_loop(with_estimates(power(true), 3)), make_interpreter(with_estimates(power(true), 3))}) {
    Draw draw(4);
    for (int i = 0; i < 10000; ++i) {
      const double x = std::ldexp(1 + draw.uniform(), static_cast<int>(draw.below(100)) - 50), factor = draw.uniform();
      std::vector<double> z = {x, factor, 0, 0};
      EXPECT_TRUE(loop->run(z, 1));
      EXPECT_EQ(z[2], inverse_cube(x, factor));
    }
  }
}

TEST_F(Estimates, OfTheStateNoRootAndNoDivisionIsLeft) {
  Program p = power(true);
  p.outputs.pop_back();
  const Program fast = with_estimates(p, 3);
  for (const auto& operation : fast.operations) {
    EXPECT_NE(operation.instruction, I::divide);
    EXPECT_NE(operation.instruction, I::square_root);
  }
}

TEST_F(Estimates, NoNumberIsWrongWithoutLookingSo) {
  for (const bool is_cube : {false, true}) {
    const auto loop = make_step_loop(with_estimates(power(is_cube), 3));
    for (const double x : {0.0, -0.0, 0x1p-1074, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
      std::vector<double> z = {x, 1, 0, 0};
      EXPECT_TRUE(loop->run(z, 1));
      EXPECT_FALSE(std::isfinite(z[2])) << x;
    }
  }
}

TEST_F(Estimates, ProgramsWithoutPatternsKeepTheirBits) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Draw draw(counter_bits(9, i));
    RandomForm form = random_form(draw, 200);
    RandomCase random = random_case(draw, form);
    for (auto& operation : random.program.operations) {
      if (operation.instruction == I::divide) operation.instruction = I::multiply;
    }
    std::vector<double> expected = random.start, found = random.start;
    const bool held = make_interpreter(random.program)->run(expected, random.steps);
    ASSERT_EQ(make_step_loop(with_estimates(random.program, random.program.values()))->run(found, random.steps), held);
    for (std::size_t j = 0; held && j < expected.size(); ++j) ASSERT_TRUE(same_bits(found[j], expected[j]));
  }
}

}  // namespace
}  // namespace hamflow
