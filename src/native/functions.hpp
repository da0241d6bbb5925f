// What an instruction computes, in plain C++: for the interpreter, and for what is known while a program is compiled.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "hamflow/numerics/program.hpp"

namespace hamflow::native {

/// Whether it is a function of the system's library.
constexpr bool is_call(Instruction instruction) {
  return instruction >= Instruction::exponential && instruction != Instruction::of_lane;
}

constexpr bool is_commutative(Instruction instruction) {
  return instruction == Instruction::add || instruction == Instruction::multiply;
}

/// How many operands it has.
constexpr int arity(Instruction instruction) {
  switch (instruction) {
    case Instruction::add:
    case Instruction::subtract:
    case Instruction::multiply:
    case Instruction::divide:
    case Instruction::larger:
    case Instruction::arctangent2:
    case Instruction::power:
      return 2;
    case Instruction::choose:
      return 3;
    default:
      return 1;
  }
}

using FunctionOfOne = double (*)(double);
using FunctionOfTwo = double (*)(double, double);

/// The library's function of one number; null for any other instruction.
FunctionOfOne function_of_one(Instruction instruction);
/// The library's function of two numbers; null for any other instruction.
FunctionOfTwo function_of_two(Instruction instruction);

/// Both at once, which costs the library little more than one of them and gives the same bits.
struct SineAndCosine {
  double sine, cosine;  // as a function's result in the first two registers of a vector unit
};
inline SineAndCosine sine_and_cosine(double x) { return {std::sin(x), std::cos(x)}; }

inline double called(Instruction instruction, double a, double b) {
  if (const FunctionOfOne f = function_of_one(instruction)) return f(a);
  return function_of_two(instruction)(a, b);
}

/// @param b, c ignored where there is no such operand
inline double applied(Instruction instruction, double a, double b, double c = 0) {
  switch (instruction) {
    case Instruction::add:
      return a + b;
    case Instruction::subtract:
      return a - b;
    case Instruction::multiply:
      return a * b;
    case Instruction::divide:
      return a / b;
    case Instruction::negate:
      return -a;
    case Instruction::absolute:
      return std::fabs(a);
    case Instruction::larger:
      return a < b ? b : a;
    case Instruction::square_root:
      return std::sqrt(a);
    case Instruction::choose:
      return a > 0 ? b : c;
    case Instruction::of_lane:
      return a;  // the only one
    default:
      return called(instruction, a, b);
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
