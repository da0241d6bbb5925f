// The derivative of a program against differences of the program itself, and what cannot be differentiated.
#include "numerics/program_tangent.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "engine/recorded_tangents.hpp"

namespace hamflow {
namespace {

Operand carried(std::uint32_t i) { return {Operand::Kind::carried, i}; }
Operand result(std::uint32_t i) { return {Operand::Kind::result, i}; }
Operand constant(std::uint32_t i) { return {Operand::Kind::constant, i}; }

/// One value x -> f(x), for a function of one number or with the second operand 1.25.
Program of(Instruction instruction, bool two) {
  Program program;
  program.constants = {1.25};
  program.operations = {{instruction, carried(0), two ? constant(0) : Operand{}}};
  program.outputs = {result(0)};
  return program;
}

double value(const Program& program, double x) {
  std::vector<double> values{x};
  EXPECT_TRUE(make_interpreter(program)->run(values, 1));
  return values[0];
}

TEST(ProgramTangent, AChoiceMovesWithEachOfItsOperands) {
  Program program;
  program.constants = {1.25, 2.5};
  const auto choice_of = [](Operand a, Operand b, Operand c) {
    return Program::Operation{Instruction::choose, a, b, c};
  };
  program.operations = {
      choice_of(constant(0), constant(1), carried(0)), choice_of(constant(0), carried(0), constant(1)),
      choice_of(constant(0), constant(1), constant(0)), choice_of(carried(0), constant(1), constant(0))};
  program.outputs = {carried(0), result(0), result(1), result(2), result(3)};
  EXPECT_EQ(moving_values(program, 1), (std::vector<std::size_t>{0, 1, 2, 4}));
}

TEST(ProgramTangent, EveryInstructionHasTheSlopeOfADifference) {
  using I = Instruction;
  const bool moves[] = {true};
  const double x = 0.40625;
  for (const auto& [instruction, two] : std::initializer_list<std::pair<Instruction, bool>>{{I::add, true},
                                                                                            {I::subtract, true},
                                                                                            {I::multiply, true},
                                                                                            {I::divide, true},
                                                                                            {I::negate, false},
                                                                                            {I::sqrt, false},
                                                                                            {I::exp, false},
                                                                                            {I::log, false},
                                                                                            {I::sin, false},
                                                                                            {I::cos, false},
                                                                                            {I::tan, false},
                                                                                            {I::asin, false},
                                                                                            {I::acos, false},
                                                                                            {I::atan, false},
                                                                                            {I::sinh, false},
                                                                                            {I::cosh, false},
                                                                                            {I::tanh, false},
                                                                                            {I::atan2, true},
                                                                                            {I::power, true}}) {
    SCOPED_TRACE(static_cast<int>(instruction));
    const Program program = of(instruction, two);
    const auto both = with_tangents(program, moves, 2);
    ASSERT_TRUE(both);
    std::vector<double> values{x, 1, -3};
    ASSERT_TRUE(make_interpreter(*both)->run(values, 1));
    EXPECT_EQ(values[0], value(program, x));
    // Of order 4, d = 2^-10: its error is d^4 f^(5)/30, f^(5) largest for the logarithm, 24/x^5; its rounding below 4
    // eps/d.
    const double d = 0x1p-10;
    const double slope = (8 * (value(program, x + d) - value(program, x - d)) -
                          (value(program, x + 2 * d) - value(program, x - 2 * d))) /
                         (12 * d);
    EXPECT_NEAR(values[1], slope, std::pow(d, 4) * 24 / std::pow(x, 5) / 15 + 4 * 0x1p-52 / d);
    EXPECT_NEAR(values[2], -3 * values[1], 4 * 0x1p-52 * std::fabs(values[2])) << "a slope is linear in its vector";
  }
}

TEST(ProgramTangent, SizesAndLargerNumbersHaveNoSlopeButWhatDoesNotMoveMayHaveThem) {
  const bool moves[] = {true};
  EXPECT_FALSE(with_tangents(of(Instruction::abs, false), moves, 1));
  EXPECT_FALSE(with_tangents(of(Instruction::larger, true), moves, 1));
  const bool rests[] = {false};
  EXPECT_TRUE(with_tangents(of(Instruction::abs, false), rests, 1));
}

TEST(ProgramTangent, BothOperandsAndExchangedValues) {
  // (x, y) -> (y, x y): the Jacobian at (2, 3) is (0 1; 3 2).
  Program program;
  program.operations = {{Instruction::multiply, carried(0), carried(1)}};
  program.outputs = {carried(1), result(0)};
  const bool moves[] = {true, true};
  const auto both = with_tangents(program, moves, 2);
  ASSERT_TRUE(both);
  std::vector<double> values{2, 3, 1, 0, 0, 1};
  ASSERT_TRUE(make_interpreter(*both)->run(values, 1));
  EXPECT_EQ(values, (std::vector<double>{3, 6, 0, 3, 1, 2}));
}

}  // namespace
}  // namespace hamflow
