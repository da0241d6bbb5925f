#include "hamflow/detail/numerics/program.hpp"

#include "hamflow/detail/formula/code.hpp"

namespace hamflow::formula {

namespace {

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
  /// Emits the same products as Emission::whole_power.
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
    return step.b < 0 ? add(step.op, at(step.a)) : add(step.op, at(step.a), at(step.b));
  }

  Program program_;
  std::vector<Operand> places_;
};

}  // namespace

Program program_of(const Code& code, const std::vector<double>& constants) {
  return ProgramWriter(code, constants).take();
}

}  // namespace hamflow::formula
