#include "functions.hpp"

namespace hamflow::native {

// A program lives as long as its simulation, and so long the functions do not change: those in use are called directly.
FunctionOfOne function_of_one(Instruction instruction) {
  switch (instruction) {
    case Instruction::sine_of_both:
      return function_of_one(Instruction::sin);
    case Instruction::cosine_of_both:
      return function_of_one(Instruction::cos);
#define HAMFLOW_CASE(name, symmetry, rule, series) \
  case Instruction::name:                          \
    return functions_are_portable() ? portable::name : static_cast<FunctionOfOne>(std::name);
      HAMFLOW_FUNCTIONS(HAMFLOW_CASE)
#undef HAMFLOW_CASE
    default:
      return nullptr;
  }
}

FunctionOfTwo function_of_two(Instruction instruction) {
  switch (instruction) {
    case Instruction::atan2:
      return functions_are_portable() ? portable::atan2 : static_cast<FunctionOfTwo>(std::atan2);
    case Instruction::power:
      return functions_are_portable() ? portable::pow : static_cast<FunctionOfTwo>(std::pow);
    default:
      return nullptr;
  }
}

}  // namespace hamflow::native
