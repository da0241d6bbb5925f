#include <algorithm>
#include <bit>
#include <limits>
#include <optional>
#include <unordered_map>

#include "functions.hpp"
#include "passes.hpp"

namespace hamflow::native {
namespace {

using Kind = Operand::Kind;
using Operation = Program::Operation;

struct OperationHash {
  std::size_t operator()(const Operation& operation) const {
    std::uint64_t key = static_cast<std::uint64_t>(operation.instruction);
    for (const Operand& operand : {operation.a, operation.b, operation.c}) {
      key = (key ^ (static_cast<std::uint64_t>(operand.kind) << 32 | operand.index)) * 0x9e3779b97f4a7c15u;
      key ^= key >> 29;
    }
    return key;
  }
};

/// Whether x is a power of two with a finite reciprocal, so that a division by x is an exact multiplication.
bool has_exact_reciprocal(double x) {
  int exponent = 0;
  return std::fabs(std::frexp(x, &exponent)) == 0.5 && std::isfinite(1 / x);
}

/// Builds a program of simplified operations, without duplicates.
class Simplifier {
 public:
  explicit Simplifier(const Program& program) {
    std::vector<Operand> places;  // the operands in the new program for the results of `program`
    places.reserve(program.operations.size());
    const auto moved = [&](const Operand& operand) {
      if (operand.kind == Kind::result) return places[operand.index];
      if (operand.kind == Kind::constant) return constant(program.constants[operand.index]);
      return operand;
    };
    for (const Operation& operation : program.operations)
      places.push_back(result({operation.instruction, moved(operation.a), moved(operation.b), moved(operation.c)}));
    for (const Operand& output : program.outputs) new_.outputs.push_back(moved(output));
    for (const Program::Check& check : program.checks) {
      const Program::Check here{check.kind, moved(check.a), moved(check.b)};
      const auto a = value(here.a), b = here.b.kind == Kind::none ? std::optional(0.0) : value(here.b);
      if (!(a && b && holds(here.kind, *a, *b)) &&
          std::find(new_.checks.begin(), new_.checks.end(), here) == new_.checks.end())
        new_.checks.push_back(here);
    }
    new_.ends_at = program.ends_at;
  }

  Program take() && { return std::move(new_); }

 private:
  Operand constant(double x) {
    const auto [found, is_new] =
        constants_.try_emplace(std::bit_cast<std::uint64_t>(x), static_cast<std::uint32_t>(new_.constants.size()));
    if (is_new) new_.constants.push_back(x);
    return {Kind::constant, found->second};
  }

  std::optional<double> value(const Operand& operand) const {
    if (operand.kind != Kind::constant) return std::nullopt;
    return new_.constants[operand.index];
  }

  /// Returns x if the operand is a negation -x.
  std::optional<Operand> negated(const Operand& operand) const {
    if (operand.kind != Kind::result) return std::nullopt;
    const Operation& operation = new_.operations[operand.index];
    if (operation.instruction != Instruction::negate) return std::nullopt;
    return operation.a;
  }

  Operand result(const Operation& operation) {
    const auto [instruction, a, b, c] = operation;
    if (instruction == Instruction::choose) {
      if (b == c) return b;
      if (const auto x = value(a)) return *x > 0 ? b : c;
    }
    if (c.kind != Kind::none) return numbered(operation);
    const auto x = value(a), y = value(b);
    if (x && (y || b.kind == Kind::none)) return constant(applied(instruction, *x, y.value_or(0)));
    const auto minus_a = negated(a), minus_b = negated(b);
    switch (instruction) {
      case Instruction::add:  // x + (-0) = x for every x
        if (minus_b) return result({Instruction::subtract, a, *minus_b});
        if (minus_a) return result({Instruction::subtract, b, *minus_a});
        if (y && *y == 0 && std::signbit(*y)) return a;
        if (x && *x == 0 && std::signbit(*x)) return b;
        break;
      case Instruction::subtract:
        if (minus_b) return result({Instruction::add, a, *minus_b});
        if (y && *y == 0 && !std::signbit(*y)) return a;
        break;
      case Instruction::multiply:
        if (minus_a && minus_b) return result({instruction, *minus_a, *minus_b});
        if (minus_a && y) return result({instruction, *minus_a, constant(-*y)});
        if (minus_b && x) return result({instruction, *minus_b, constant(-*x)});
        if (x) return result_by_constant(b, *x, operation);
        if (y) return result_by_constant(a, *y, operation);
        break;
      case Instruction::divide:
        if (minus_a && minus_b) return result({instruction, *minus_a, *minus_b});
        if (minus_a && y) return result({instruction, *minus_a, constant(-*y)});
        if (minus_b && x) return result({instruction, constant(-*x), *minus_b});
        if (y && has_exact_reciprocal(*y)) return result({Instruction::multiply, a, constant(1 / *y)});
        break;
      case Instruction::negate:
        if (minus_a) return *minus_a;
        break;
      case Instruction::abs:
        if (minus_a) return result({instruction, *minus_a, {}});
        break;
      case Instruction::larger:
        if (a == b) return a;
        break;
      default:
        break;
    }
    return numbered(operation);
  }

  Operand result_by_constant(const Operand& a, double factor, const Operation& product) {
    if (factor == 1) return a;
    if (factor == -1) return result({Instruction::negate, a, {}});
    if (factor == 2) return result({Instruction::add, a, a});  // an addition has the shorter latency
    return numbered(product);
  }

  Operand numbered(Operation operation) {
    const auto order = [](const Operand& x) { return std::pair(x.kind, x.index); };
    if (is_commutative(operation.instruction) && order(operation.b) < order(operation.a))
      std::swap(operation.a, operation.b);
    const auto [found, is_new] = numbers_.try_emplace(operation, static_cast<std::uint32_t>(new_.operations.size()));
    if (is_new) new_.operations.push_back(operation);
    return {Kind::result, found->second};
  }

  Program new_;
  std::unordered_map<std::uint64_t, std::uint32_t> constants_;  // bits -> index
  std::unordered_map<Operation, std::uint32_t, OperationHash> numbers_;
};

/// Removes results and constants on which no output and no check depends.
Program without_dead_code(const Program& program) {
  std::vector<char> live(program.operations.size());
  const auto mark = [&](const Operand& operand) {
    if (operand.kind == Kind::result) live[operand.index] = 1;
  };
  for (const Operand& output : program.outputs) mark(output);
  for (const auto& check : program.checks) mark(check.a), mark(check.b);
  for (std::size_t i = program.operations.size(); i-- > 0;) {
    if (live[i]) mark(program.operations[i].a), mark(program.operations[i].b), mark(program.operations[i].c);
  }

  Program kept;
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> places(live.size(), unused), constants(program.constants.size(), unused);
  const auto moved = [&](Operand operand) {
    if (operand.kind == Kind::result) operand.index = places[operand.index];
    if (operand.kind == Kind::constant) {
      std::uint32_t& place = constants[operand.index];
      if (place == unused) {
        place = static_cast<std::uint32_t>(kept.constants.size());
        kept.constants.push_back(program.constants[operand.index]);
      }
      operand.index = place;
    }
    return operand;
  };
  for (std::size_t i = 0; i < live.size(); ++i) {
    if (!live[i]) continue;
    const Operation& operation = program.operations[i];
    places[i] = static_cast<std::uint32_t>(kept.operations.size());
    kept.operations.push_back({operation.instruction, moved(operation.a), moved(operation.b), moved(operation.c)});
  }
  for (const Operand& output : program.outputs) kept.outputs.push_back(moved(output));
  kept.ends_at = program.ends_at;
  for (const auto& check : program.checks) kept.checks.push_back({check.kind, moved(check.a), moved(check.b)});
  return kept;
}

}  // namespace

Program simplified(const Program& program) { return without_dead_code(Simplifier(program).take()); }

}  // namespace hamflow::native
