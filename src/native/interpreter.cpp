// Interprets a program operation by operation. One array contains the numbers of a step: carried values, constants,
// results.
#include <algorithm>

#include "functions.hpp"

namespace hamflow {
namespace {

class Interpreter final : public StepLoop {
 public:
  explicit Interpreter(const Program& program)
      : values_(program.values()), constants_(program.constants), ends_at_(program.ends_at) {
    const auto place = [&](const Operand& operand) -> std::uint32_t {
      switch (operand.kind) {
        case Operand::Kind::carried:
          return operand.index;
        case Operand::Kind::constant:
          return static_cast<std::uint32_t>(values_ + operand.index);
        case Operand::Kind::result:
          return static_cast<std::uint32_t>(values_ + constants_.size() + operand.index);
        case Operand::Kind::none:
          break;
      }
      return 0;  // a missing operand reads the first number and ignores it
    };
    for (const auto& operation : program.operations)
      lines_.push_back({operation.instruction, place(operation.a), place(operation.b), place(operation.c)});
    for (const auto& check : program.checks) checks_.push_back({check.kind, place(check.a), place(check.b)});
    for (const Operand& output : program.outputs) outputs_.push_back(place(output));
  }

  std::int64_t take(std::span<double> carried, std::int64_t steps) const override {
    const std::size_t first = values_ + constants_.size();
    thread_local std::vector<double> x;  // kept between calls, because a call of a few steps should not allocate
    x.resize(std::max(x.size(), first + lines_.size() + values_));
    std::copy_n(carried.begin(), values_, x.begin());
    std::copy(constants_.begin(), constants_.end(), x.begin() + static_cast<std::ptrdiff_t>(values_));
    double* const results = x.data() + first;
    double* const next = results + lines_.size();
    std::int64_t step = 0;
    for (bool ended = false; step < steps && !ended; ++step) {
      double* result = results;
      for (const Line& line : lines_) *result++ = native::applied(line.instruction, x[line.a], x[line.b], x[line.c]);
      for (const Check& check : checks_) {
        if (!native::holds(check.kind, x[check.a], x[check.b])) return -1;
      }
      for (std::size_t k = 0; k < values_; ++k) next[k] = x[outputs_[k]];  // a copy, because outputs may permute values
      std::copy_n(next, values_, x.data());
      for (const std::uint32_t k : ends_at_) ended = ended || x[k] != 0;
    }
    std::copy_n(x.data(), values_, carried.begin());
    return step;
  }

 private:
  struct Line {
    Instruction instruction;
    std::uint32_t a, b, c;
  };
  struct Check {
    Program::Check::Kind kind;
    std::uint32_t a, b;
  };
  std::size_t values_;
  std::vector<double> constants_;
  std::vector<Line> lines_;
  std::vector<Check> checks_;
  std::vector<std::uint32_t> outputs_;
  std::vector<std::uint32_t> ends_at_;
};

}  // namespace

std::unique_ptr<const StepLoop> make_interpreter(const Program& program) {
  return std::make_unique<Interpreter>(program);
}

}  // namespace hamflow
