// kernel = "fast": powers of u by an estimate of u^(-1/2) and the series of what it lacks.
//
// The processor gives y = u^(-1/2) (1 + delta), |delta| < 2^-14. With e = 1 - u y^2, u = (1 - e)/y^2 and
//     u^(-3/2) = y^3 (1 - e)^(-3/2) = y^3 (1 + e (3/2 + 15/8 e + 35/16 e^2 + 315/128 e^3)) + R,   |R| < 2^-63 y^3,
//     u^(-1/2) = y (1 - e)^(-1/2) = y (1 + e (1/2 + 3/8 e + 5/16 e^2 + 35/128 e^3)) + R,   |R| < 2^-66 y.
// A quotient alone gains nothing: as many operations follow its estimate as a division takes.
#include <optional>

#include "functions.hpp"
#include "passes.hpp"

namespace hamflow {
namespace native {
namespace {

using Kind = Operand::Kind;

/// k/(u sqrt(u)) or k/sqrt(u).
struct Pattern {
  Operand k, u;
  bool is_cube;
};

std::optional<Pattern> pattern_of(const Program& program, const Program::Operation& operation) {
  const auto root_of = [&](const Operand& operand) -> std::optional<Operand> {
    if (operand.kind != Kind::result) return std::nullopt;
    const auto& made = program.operations[operand.index];
    return made.instruction == Instruction::square_root ? std::optional(made.a) : std::nullopt;
  };
  if (operation.instruction != Instruction::divide) return std::nullopt;
  if (const auto u = root_of(operation.b)) return Pattern{operation.a, *u, false};
  if (operation.b.kind != Kind::result) return std::nullopt;
  const auto& [instruction, a, b, c] = program.operations[operation.b.index];
  if (instruction != Instruction::multiply) return std::nullopt;
  if (root_of(a) == b) return Pattern{operation.a, b, true};
  if (root_of(b) == a) return Pattern{operation.a, a, true};
  return std::nullopt;
}

class Rewriter {
 public:
  Rewriter(const Program& program, std::size_t state) : old_(program) {
    mark_state(state);
    new_.constants = old_.constants;
    for (std::size_t i = 0; i < old_.operations.size(); ++i) rewrite(i);
    for (std::size_t k = 0; k < old_.outputs.size(); ++k)
      new_.outputs.push_back(moved(old_.outputs[k], k < state ? fast_ : exact_));
    for (const auto& check : old_.checks)
      new_.checks.push_back({check.kind, moved(check.a, fast_), moved(check.b, fast_)});
  }

  Program take() && { return std::move(new_); }

 private:
  void mark_state(std::size_t state) {
    in_state_.resize(old_.operations.size());
    const auto mark = [&](const Operand& operand) {
      if (operand.kind == Kind::result) in_state_[operand.index] = 1;
    };
    for (std::size_t k = 0; k < state; ++k) mark(old_.outputs[k]);
    for (std::size_t i = in_state_.size(); i-- > 0;) {
      const auto& [instruction, a, b, c] = old_.operations[i];
      if (in_state_[i]) mark(a), mark(b), mark(c);
    }
  }

  static Operand moved(const Operand& operand, const std::vector<Operand>& places) {
    return operand.kind == Kind::result ? places[operand.index] : operand;
  }

  /// What the state is computed from exists once, but that others see a quotient as it was.
  void rewrite(std::size_t i) {
    const Program::Operation& old = old_.operations[i];
    const auto copied = [&](const std::vector<Operand>& places) {
      return add(old.instruction, moved(old.a, places), moved(old.b, places), moved(old.c, places));
    };
    const auto pattern = pattern_of(old_, old);
    if (in_state_[i] && pattern) {
      const Operand exact = copied(exact_);
      fast_.push_back(series(moved(pattern->u, fast_), moved(pattern->k, fast_), pattern->is_cube));
      exact_.push_back(exact);
    } else {
      fast_.push_back(copied(in_state_[i] ? fast_ : exact_));
      exact_.push_back(fast_.back());
    }
  }

  /// The operations of detail::inverse_cube_series (numerics/inverse_cube.hpp), in its order.
  Operand series(const Operand& u, const Operand& k, bool is_cube) {
    const Operand y = add(Instruction::inverse_root_estimate, u);
    const Operand yy = add(Instruction::multiply, y, y);
    const Operand e = add(Instruction::fused_subtract, u, yy, number(1));
    const Operand low =
        add(Instruction::fused_add, e, number(is_cube ? 15.0 / 8 : 3.0 / 8), number(is_cube ? 1.5 : 0.5));
    const Operand high = add(Instruction::fused_add, e, number(is_cube ? 315.0 / 128 : 35.0 / 128),
                             number(is_cube ? 35.0 / 16 : 5.0 / 16));
    const Operand sum = add(Instruction::fused_add, add(Instruction::multiply, e, e), high, low);
    const Operand power = is_cube ? add(Instruction::multiply, y, yy) : y;
    const Operand leading = add(Instruction::multiply, k, power);
    return add(Instruction::fused_add, add(Instruction::multiply, leading, e), sum, leading);
  }

  Operand number(double x) {
    new_.constants.push_back(x);
    return {Kind::constant, static_cast<std::uint32_t>(new_.constants.size() - 1)};
  }
  Operand add(Instruction instruction, const Operand& a, const Operand& b = {}, const Operand& c = {}) {
    new_.operations.push_back({instruction, a, b, c});
    return {Kind::result, static_cast<std::uint32_t>(new_.operations.size() - 1)};
  }

  const Program& old_;
  Program new_;
  std::vector<char> in_state_;
  std::vector<Operand> fast_, exact_;  // of the old results: for the state, for others
};

}  // namespace
}  // namespace native

Program with_estimates(const Program& program, std::size_t state) {
  if (!fast_kernel_available()) return program;
  return native::simplified(native::Rewriter(native::simplified(program), state).take());
}

}  // namespace hamflow
