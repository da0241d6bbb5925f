#include <map>
#include <optional>

#include "passes.hpp"

namespace hamflow::native {

namespace {
using Kind = Operand::Kind;
using Number = std::pair<Kind, std::uint32_t>;

/// The operations that compute the sine and the cosine of a number.
struct Asked {
  std::optional<std::size_t> sine, cosine;
};
std::map<Number, Asked> asked_of(const Program& program) {
  std::map<Number, Asked> all;
  for (std::size_t i = 0; i < program.operations.size(); ++i) {
    const auto& [instruction, a, b, c] = program.operations[i];
    Asked& here = all[{a.kind, a.index}];
    if (instruction == Instruction::sin) here.sine = i;
    if (instruction == Instruction::cos) here.cosine = i;
  }
  std::erase_if(all, [](const auto& entry) { return !entry.second.sine || !entry.second.cosine; });
  return all;
}
}  // namespace

Program with_both(const Program& program) {
  const std::map<Number, Asked> asked = asked_of(program);
  if (asked.empty()) return program;
  Program result{{}, program.constants, {}, {}, program.ends_at};
  std::vector<std::optional<std::uint32_t>> places(program.operations.size());
  const auto moved = [&](const Operand& operand) {
    return operand.kind == Kind::result ? Operand{Kind::result, *places[operand.index]} : operand;
  };
  const auto append = [&](std::size_t from, Instruction instruction) {
    const auto& [old, a, b, c] = program.operations[from];
    places[from] = static_cast<std::uint32_t>(result.operations.size());
    result.operations.push_back({instruction, moved(a), moved(b), moved(c)});
  };
  for (std::size_t i = 0; i < program.operations.size(); ++i) {
    if (places[i]) continue;
    const auto& [instruction, a, b, c] = program.operations[i];
    const bool is_one = instruction == Instruction::sin || instruction == Instruction::cos;
    const auto both = is_one ? asked.find({a.kind, a.index}) : asked.end();
    if (both == asked.end()) {
      append(i, instruction);
    } else {
      append(*both->second.sine, Instruction::sine_of_both);
      append(*both->second.cosine, Instruction::cosine_of_both);
    }
  }
  for (const Operand& output : program.outputs) result.outputs.push_back(moved(output));
  for (const auto& check : program.checks) result.checks.push_back({check.kind, moved(check.a), moved(check.b)});
  return result;
}

}  // namespace hamflow::native
