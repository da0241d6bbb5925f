// The meaning of instructions in plain C++. The interpreter uses it, and simplify.cpp uses it to fold constants.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "hamflow/detail/numerics/program.hpp"

namespace hamflow::native {

/// Whether the instruction calls a function.
constexpr bool is_call(Instruction instruction) {
  return is_listed_function(instruction) || instruction == Instruction::atan2 || instruction == Instruction::power ||
         instruction == Instruction::sine_of_both || instruction == Instruction::cosine_of_both;
}

constexpr bool is_commutative(Instruction instruction) {
  return instruction == Instruction::add || instruction == Instruction::multiply;
}

/// The number of operands.
constexpr int arity(Instruction instruction) {
  if (instruction == Instruction::choose) return 3;
  return takes_two(instruction) || instruction == Instruction::larger ? 2 : 1;
}

using FunctionOfOne = double (*)(double);
using FunctionOfTwo = double (*)(double, double);

/// Returns the function with one argument; null for any other instruction.
FunctionOfOne function_of_one(Instruction instruction);
/// Returns the function with two arguments; null for any other instruction.
FunctionOfTwo function_of_two(Instruction instruction);

/// Sine and cosine of one number. Computing both costs little more than one of them, and gives the same bits.
struct SineAndCosine {
  double sine, cosine;  // as the result of a function they are in the first two vector registers
};
inline SineAndCosine sine_and_cosine(double x) { return {sin(x), cos(x)}; }

/// Applies an instruction.   @param b, c ignored if the instruction has fewer operands
inline double applied(Instruction instruction, double a, double b, double c = 0) {
  switch (instruction) {
    case Instruction::larger:
      return a < b ? b : a;
    case Instruction::choose:
      return a > 0 ? b : c;
    case Instruction::sine_of_both:
      return sin(a);
    case Instruction::cosine_of_both:
      return cos(a);
    case Instruction::of_lane:
      return a;  // a single number is the only lane
    default:
      return hamflow::applied(instruction, a, b);
  }
}

inline bool holds(Program::Check::Kind kind, double a, double b) {
  switch (kind) {
    case Program::Check::Kind::finite:
      return std::isfinite(a);
    case Program::Check::Kind::equal:
      return a == b;
    case Program::Check::Kind::unequal:
      return a != b;
    case Program::Check::Kind::less:
      return a < b;
    case Program::Check::Kind::not_less:
      return !(a < b);
  }
  return false;
}

}  // namespace hamflow::native
