#include "hamflow/detail/run/step_sums.hpp"

namespace hamflow {

namespace {
/// Appends operations to a program.
class Appending {
 public:
  explicit Appending(Program& program) : program_(program) {}
  Operand operator()(Instruction instruction, Operand a, Operand b, Operand c = {}) const {
    program_.operations.push_back({instruction, a, b, c});
    return {Operand::Kind::result, static_cast<std::uint32_t>(program_.operations.size() - 1)};
  }

 private:
  Program& program_;
};
}  // namespace

std::optional<Program> with_sums(const Program& program, std::span<const std::size_t> state,
                                 std::optional<std::size_t> undone, std::span<const NamedExpression> expressions) {
  using I = Instruction;
  Program all = program;
  const Appending append(all);
  std::vector<Operand> numbers;
  for (const std::size_t k : state) numbers.push_back(program.outputs[k]);
  for (const NamedExpression& each : expressions) {
    const std::optional<Operand> x = each.expression.append_to(all, numbers);
    if (!x) return std::nullopt;
    const auto place = static_cast<std::uint32_t>(all.outputs.size());
    const Operand sum{Operand::Kind::carried, place};
    const Operand lost{Operand::Kind::carried, place + 1};
    // The rounding error of a sum, without a branch; the same number as in StepSum. [Knuth1997, 4.2.2]
    const Operand next = append(I::add, sum, *x);
    const Operand part = append(I::subtract, next, sum);
    const Operand of_sum = append(I::subtract, sum, append(I::subtract, next, part));
    const Operand error = append(I::add, of_sum, append(I::subtract, *x, part));
    const Operand more = append(I::add, lost, error);
    const auto unless_undone = [&](Operand before, Operand after) {
      return undone ? append(I::choose, program.outputs[*undone], before, after) : after;
    };
    all.outputs.push_back(unless_undone(sum, next));
    all.outputs.push_back(unless_undone(lost, more));
  }
  return all;
}

}  // namespace hamflow
