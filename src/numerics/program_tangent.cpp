#include "program_tangent.hpp"

namespace hamflow {

namespace {
/// Appends operations to a program. An operand of kind `none` is a zero slope.
class Differentiation {
 public:
  Differentiation(const Program& program, std::span<const bool> moves, std::size_t vectors)
      : in_(program), moves_(moves), vectors_(vectors) {
    out_.constants = program.constants;
  }

  std::optional<Program> made() {
    const std::size_t values = in_.values();
    std::uint32_t moving = 0;
    for (const bool m : moves_) moving += m ? 1 : 0;
    place_.resize(in_.operations.size());
    slopes_.assign(vectors_, std::vector<Operand>(in_.operations.size()));
    first_.assign(vectors_, std::vector<Operand>(values));
    for (std::size_t j = 0; j < vectors_; ++j) {
      std::uint32_t at = static_cast<std::uint32_t>(values + j * moving);
      for (std::size_t k = 0; k < values; ++k) {
        if (moves_[k]) first_[j][k] = {Operand::Kind::carried, at++};
      }
    }
    for (std::size_t i = 0; i < in_.operations.size(); ++i) {
      const auto& operation = in_.operations[i];
      if (operation.instruction == Instruction::choose) {  // selects the slope with the value
        choose(i);
        continue;
      }
      if (operation.c.kind != Operand::Kind::none) return std::nullopt;  // of estimates, which are no functions
      const Operand a = moved(operation.a);
      const Operand b = moved(operation.b);
      place_[i] = apply(operation.instruction, a, b);
      for (std::size_t j = 0; j < vectors_; ++j) {
        const Operand da = slope(j, operation.a);
        const Operand db = slope(j, operation.b);
        if (is_zero(da) && is_zero(db)) continue;
        if (!differentiate(operation.instruction, a, b, place_[i], da, db, slopes_[j][i])) return std::nullopt;
      }
    }
    for (const Operand& output : in_.outputs) out_.outputs.push_back(moved(output));
    for (std::size_t j = 0; j < vectors_; ++j) {
      for (std::size_t k = 0; k < values; ++k) {
        if (!moves_[k]) continue;
        const Operand d = slope(j, in_.outputs[k]);
        out_.outputs.push_back(is_zero(d) ? constant(0.0) : d);
      }
    }
    for (auto check : in_.checks) {
      check.a = moved(check.a);
      check.b = moved(check.b);
      out_.checks.push_back(check);
    }
    out_.ends_at = in_.ends_at;
    return std::move(out_);
  }

 private:
  static bool is_zero(const Operand& x) { return x.kind == Operand::Kind::none; }
  Operand moved(const Operand& x) const { return x.kind == Operand::Kind::result ? place_[x.index] : x; }
  Operand slope(std::size_t j, const Operand& x) const {
    switch (x.kind) {
      case Operand::Kind::carried:
        return first_[j][x.index];
      case Operand::Kind::result:
        return slopes_[j][x.index];
      default:
        return {};
    }
  }
  Operand constant(double c) {
    out_.constants.push_back(c);
    return {Operand::Kind::constant, static_cast<std::uint32_t>(out_.constants.size() - 1)};
  }
  Operand apply(Instruction instruction, Operand a, Operand b = {}) {
    out_.operations.push_back({instruction, a, b, {}});
    return {Operand::Kind::result, static_cast<std::uint32_t>(out_.operations.size() - 1)};
  }
  Operand times(Operand a, Operand b) {
    return is_zero(a) || is_zero(b) ? Operand{} : apply(Instruction::multiply, a, b);
  }
  Operand plus(Operand a, Operand b) {
    if (is_zero(a)) return b;
    return is_zero(b) ? a : apply(Instruction::add, a, b);
  }
  Operand minus(Operand a, Operand b) {
    if (is_zero(b)) return a;
    return is_zero(a) ? apply(Instruction::negate, b) : apply(Instruction::subtract, a, b);
  }

  void choose(std::size_t i) {
    const auto& operation = in_.operations[i];
    const auto made = [&](const Operand& b, const Operand& c) -> Operand {
      out_.operations.push_back({Instruction::choose, moved(operation.a), b, c});
      return {Operand::Kind::result, static_cast<std::uint32_t>(out_.operations.size() - 1)};
    };
    place_[i] = made(moved(operation.b), moved(operation.c));
    for (std::size_t j = 0; j < vectors_; ++j) {
      const Operand db = slope(j, operation.b);
      const Operand dc = slope(j, operation.c);
      if (is_zero(db) && is_zero(dc)) continue;
      slopes_[j][i] = made(is_zero(db) ? constant(0.0) : db, is_zero(dc) ? constant(0.0) : dc);
    }
  }

  /// Computes dy for y = instruction(a, b). Returns false if the instruction has no derivative.
  bool differentiate(Instruction instruction, Operand a, Operand b, Operand y, Operand da, Operand db, Operand& dy) {
    using I = Instruction;
    switch (instruction) {
      case I::add:
        dy = plus(da, db);
        return true;
      case I::subtract:
        dy = minus(da, db);
        return true;
      case I::multiply:
        dy = plus(times(a, db), times(da, b));
        return true;
      case I::divide:  // (da - y db)/b
        dy = apply(I::divide, minus(da, times(y, db)), b);
        return true;
      case I::negate:
        dy = apply(I::negate, da);
        return true;
      case I::sqrt:
        dy = apply(I::divide, da, apply(I::add, y, y));
        return true;
      case I::atan2: {  // of a/b: (b da - a db)/(a^2 + b^2)
        const Operand square = apply(I::add, apply(I::multiply, a, a), apply(I::multiply, b, b));
        dy = apply(I::divide, minus(times(b, da), times(a, db)), square);
        return true;
      }
      case I::power:
        if (!is_zero(db)) return false;
        dy = times(apply(I::multiply, b, apply(I::power, a, apply(I::subtract, b, constant(1)))), da);
        return true;
      default: {
        if (!is_listed_function(instruction)) return false;
        const DerivativeRule<Line> rule =
            derivative_rule(instruction, Line{this, a}, Line{this, y}, Line{this, constant(1)});
        dy = apply(rule.divides ? I::divide : I::multiply, da, rule.by.at);
        return true;
      }
    }
  }

  /// A value of the program as a number, for the rules of derivatives.
  struct Line {
    Differentiation* program;
    Operand at;

    Line made(Instruction instruction, Operand b = {}) const { return {program, program->apply(instruction, at, b)}; }
    friend Line operator+(const Line& a, const Line& b) { return a.made(Instruction::add, b.at); }
    friend Line operator-(const Line& a, const Line& b) { return a.made(Instruction::subtract, b.at); }
    friend Line operator*(const Line& a, const Line& b) { return a.made(Instruction::multiply, b.at); }
    friend Line operator-(const Line& a) { return a.made(Instruction::negate); }
    friend Line sqrt(const Line& a) { return a.made(Instruction::sqrt); }
#define HAMFLOW_LINE_FUNCTION(name, symmetry, rule, series) \
  friend Line name(const Line& a) { return a.made(Instruction::name); }
    HAMFLOW_FUNCTIONS(HAMFLOW_LINE_FUNCTION)
#undef HAMFLOW_LINE_FUNCTION
  };

  const Program& in_;
  std::span<const bool> moves_;
  std::size_t vectors_;
  Program out_;
  std::vector<Operand> place_;
  std::vector<std::vector<Operand>> slopes_;  // of results, for each vector
  std::vector<std::vector<Operand>> first_;   // slopes of the carried values
};
}  // namespace

std::optional<Program> with_tangents(const Program& program, std::span<const bool> moves, std::size_t vectors) {
  return Differentiation(program, moves, vectors).made();
}

}  // namespace hamflow
