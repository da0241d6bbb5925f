#include "functions.hpp"

namespace hamflow::native {

FunctionOfOne function_of_one(Instruction instruction) {
  switch (instruction) {
    case Instruction::exponential:
      return std::exp;
    case Instruction::logarithm:
      return std::log;
    case Instruction::sine:
    case Instruction::sine_of_both:
      return std::sin;
    case Instruction::cosine:
    case Instruction::cosine_of_both:
      return std::cos;
    case Instruction::tangent:
      return std::tan;
    case Instruction::arcsine:
      return std::asin;
    case Instruction::arccosine:
      return std::acos;
    case Instruction::arctangent:
      return std::atan;
    case Instruction::sinh:
      return std::sinh;
    case Instruction::cosh:
      return std::cosh;
    case Instruction::tanh:
      return std::tanh;
    default:
      return nullptr;
  }
}

FunctionOfTwo function_of_two(Instruction instruction) {
  switch (instruction) {
    case Instruction::arctangent2:
      return std::atan2;
    case Instruction::power:
      return std::pow;
    default:
      return nullptr;
  }
}

}  // namespace hamflow::native
