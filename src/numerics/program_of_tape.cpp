#include "program_of_tape.hpp"

#include <limits>
#include <stdexcept>

namespace hamflow {

namespace {
/// Fills a program in the order of the tape, without unused operations.
class Translation {
 public:
  explicit Translation(const Tape<double>& tape) : tape_(tape), place_(tape.nodes.size()) {}

  Program program() {
    mark_needed();
    for (std::size_t i = 0; i < tape_.nodes.size(); ++i) {
      if (needed_[i]) translate(i);
    }
    for (const int output : tape_.outputs) program_.outputs.push_back(at(output));
    for (const auto& guard : tape_.guards) add_check(guard);
    return std::move(program_);
  }

 private:
  const TapeNode& node(int i) const { return tape_.nodes[static_cast<std::size_t>(i)]; }
  Operand at(int i) const { return place_[static_cast<std::size_t>(i)]; }

  /// The companion of a function, which only Taylor coefficients need, is not an operand.
  static bool has_second_operand(Operation operation) {
    return takes_two(operation) || operation == Operation::larger || operation == Operation::choose;
  }
  void mark_needed() {
    needed_.assign(tape_.nodes.size(), false);
    for (const int output : tape_.outputs) needed_[static_cast<std::size_t>(output)] = true;
    for (const auto& guard : tape_.guards) needed_[static_cast<std::size_t>(guard.node)] = true;
    for (std::size_t i = tape_.nodes.size(); i-- > 0;) {
      const TapeNode& n = tape_.nodes[i];
      if (!needed_[i]) continue;
      if (n.a >= 0) needed_[static_cast<std::size_t>(n.a)] = true;
      if (has_second_operand(n.operation)) needed_[static_cast<std::size_t>(n.b)] = true;
      if (n.c >= 0) needed_[static_cast<std::size_t>(n.c)] = true;
    }
    for (std::size_t i = 0; i < tape_.inputs; ++i) needed_[i] = true;  // they are the first nodes
  }

  Operand constant(int index) {
    const double value = tape_.constants[static_cast<std::size_t>(index)];
    return constant(value);
  }
  Operand constant(double value) {
    program_.constants.push_back(value);
    return {Operand::Kind::constant, static_cast<std::uint32_t>(program_.constants.size() - 1)};
  }

  void translate(std::size_t i) {
    const TapeNode& n = tape_.nodes[i];
    const auto result = [&](Instruction instruction, Operand a, Operand b = {}, Operand c = {}) {
      place_[i] = {Operand::Kind::result, static_cast<std::uint32_t>(program_.operations.size())};
      program_.operations.push_back({instruction, a, b, c});
    };
    const auto with_constant = [&](Instruction instruction) { result(instruction, at(n.a), constant(n.constant)); };
    switch (n.operation) {
      case Operation::symbol:
        place_[i] = {Operand::Kind::carried, static_cast<std::uint32_t>(inputs_++)};
        return;
      case Operation::number:
        place_[i] = constant(n.constant);
        return;
      case Operation::add_constant:
        return with_constant(Instruction::add);
      case Operation::scale:
        return with_constant(Instruction::multiply);
      case Operation::divide_constant:
        return with_constant(Instruction::divide);
      case Operation::square:
        return result(Instruction::multiply, at(n.a), at(n.a));
      case Operation::invert:
        return result(Instruction::divide, constant(n.constant), at(n.a));
      case Operation::power_constant:
        return with_constant(Instruction::power);
      case Operation::choose:
        return result(Instruction::choose, at(n.a), at(n.b), at(n.c));
      default:
        return has_second_operand(n.operation) ? result(n.operation, at(n.a), at(n.b)) : result(n.operation, at(n.a));
    }
  }

  using Guard = Tape<double>::Guard;
  void add_check(const Guard& guard) {
    using Kind = Program::Check::Kind;
    const Operand a = at(guard.node);
    if (guard.relation == Tape<double>::Relation::greater && !guard.holds &&
        !(guard.value < std::numeric_limits<double>::max())) {
      program_.checks.push_back({Kind::finite, a, {}});
      return;
    }
    const Operand b = constant(guard.value);
    switch (guard.relation) {
      case Tape<double>::Relation::equal:
        program_.checks.push_back({guard.holds ? Kind::equal : Kind::unequal, a, b});
        return;
      case Tape<double>::Relation::less:
        program_.checks.push_back({guard.holds ? Kind::less : Kind::not_less, a, b});
        return;
      case Tape<double>::Relation::greater:
        program_.checks.push_back({guard.holds ? Kind::less : Kind::not_less, b, a});
        return;
    }
  }

  const Tape<double>& tape_;
  std::vector<Operand> place_;
  std::vector<bool> needed_;
  std::size_t inputs_ = 0;
  Program program_;
};
}  // namespace

Program program_of(const Tape<double>& tape) { return Translation(tape).program(); }

}  // namespace hamflow
