#include "functions.hpp"

namespace hamflow::native {

FunctionOfOne function_of_one(Instruction instruction) {
  switch (instruction) {
    case Instruction::sine_of_both:
      return hamflow::sin;
    case Instruction::cosine_of_both:
      return hamflow::cos;
#define HAMFLOW_CASE(name, symmetry, rule, series) \
  case Instruction::name:                          \
    return hamflow::name;
      HAMFLOW_FUNCTIONS(HAMFLOW_CASE)
#undef HAMFLOW_CASE
    default:
      return nullptr;
  }
}

FunctionOfTwo function_of_two(Instruction instruction) {
  switch (instruction) {
    case Instruction::atan2:
      return hamflow::atan2;
    case Instruction::power:
      return hamflow::pow;
    default:
      return nullptr;
  }
}

}  // namespace hamflow::native
