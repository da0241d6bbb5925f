#include "hamflow/numerics/program.hpp"

#include "hamflow/formula/code.hpp"

namespace hamflow::formula {

namespace {

Instruction instruction_of(Op op) {
  switch (op) {
    case Op::negate:
      return Instruction::negate;
    case Op::add:
      return Instruction::add;
    case Op::subtract:
      return Instruction::subtract;
    case Op::multiply:
      return Instruction::multiply;
    case Op::divide:
      return Instruction::divide;
    case Op::power:
      return Instruction::power;
    case Op::atan2:
      return Instruction::arctangent2;
    case Op::sqrt:
      return Instruction::square_root;
    case Op::exp:
      return Instruction::exponential;
    case Op::log:
      return Instruction::logarithm;
    case Op::sin:
      return Instruction::sine;
    case Op::cos:
      return Instruction::cosine;
    case Op::tan:
      return Instruction::tangent;
    case Op::asin:
      return Instruction::arcsine;
    case Op::acos:
      return Instruction::arccosine;
    case Op::atan:
      return Instruction::arctangent;
    case Op::sinh:
      return Instruction::sinh;
    case Op::cosh:
      return Instruction::cosh;
    case Op::tanh:
      return Instruction::tanh;
    default:
      return Instruction::absolute;
  }
}

class ProgramWriter {
 public:
  ProgramWriter(const Code& code, const std::vector<double>& constants) {
    program_.constants = constants;
    places_.resize(code.places());
    std::size_t place = 0;
    for (; place < constants.size(); ++place) places_[place] = operand(Operand::Kind::constant, place);
    for (std::size_t i = 0; i < code.symbols.size(); ++i) places_[place++] = operand(Operand::Kind::carried, i);
    for (const CodeStep& step : code.steps) places_[place++] = of_step(step);
    for (std::size_t i = 0; i < code.symbols.size(); ++i) {
      program_.outputs.push_back(operand(Operand::Kind::carried, i));
    }
    for (const int output : code.outputs) program_.outputs.push_back(at(output));
  }
  Program take() { return std::move(program_); }

 private:
  static Operand operand(Operand::Kind kind, std::size_t index) { return {kind, static_cast<std::uint32_t>(index)}; }
  Operand at(int place) const { return places_[static_cast<std::size_t>(place)]; }
  Operand add(Instruction instruction, Operand a, Operand b = {}) {
    program_.operations.push_back({instruction, a, b});
    return operand(Operand::Kind::result, program_.operations.size() - 1);
  }
  /// The products of whole_power.
  Operand whole(Operand x, int n) {
    if (n == 1) return x;
    const Operand half = whole(x, n / 2);
    const Operand even = add(Instruction::multiply, half, half);
    return n % 2 == 1 ? add(Instruction::multiply, even, x) : even;
  }
  Operand one() {
    program_.constants.push_back(1);
    return operand(Operand::Kind::constant, program_.constants.size() - 1);
  }
  Operand of_step(const CodeStep& step) {
    if (step.op == Op::power && step.b < 0) {
      if (step.whole == 0) return one();
      const Operand size = whole(at(step.a), step.whole < 0 ? -step.whole : step.whole);
      return step.whole < 0 ? add(Instruction::divide, one(), size) : size;
    }
    return step.b < 0 ? add(instruction_of(step.op), at(step.a)) : add(instruction_of(step.op), at(step.a), at(step.b));
  }

  Program program_;
  std::vector<Operand> places_;
};

}  // namespace

Program program_of(const Code& code, const std::vector<double>& constants) {
  return ProgramWriter(code, constants).take();
}

}  // namespace hamflow::formula
