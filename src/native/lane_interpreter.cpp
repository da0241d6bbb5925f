#include <algorithm>

#include "functions.hpp"
#include "lanes.hpp"

namespace hamflow::native {
namespace {

constexpr std::size_t at_once = 4;  // an inner loop of 4, which the compiler can vectorise

template <class F>
void each(std::size_t lanes, double* __restrict y, const double* a, const double* b, const F& f) {
  for (std::size_t i = 0; i < lanes; i += at_once) {
    for (std::size_t j = i; j < i + at_once; ++j) y[j] = f(a[j], b[j]);
  }
}

void apply(Instruction instruction, std::size_t lanes, double* y, const double* a, const double* b, const double* c) {
  switch (instruction) {
    case Instruction::of_lane:
      std::fill_n(y, lanes, a[static_cast<std::size_t>(b[0])]);
      return;
    case Instruction::add:
      return each(lanes, y, a, b, [](double x, double z) { return x + z; });
    case Instruction::subtract:
      return each(lanes, y, a, b, [](double x, double z) { return x - z; });
    case Instruction::multiply:
      return each(lanes, y, a, b, [](double x, double z) { return x * z; });
    case Instruction::divide:
      return each(lanes, y, a, b, [](double x, double z) { return x / z; });
    case Instruction::negate:
      return each(lanes, y, a, b, [](double x, double) { return -x; });
    case Instruction::abs:
      return each(lanes, y, a, b, [](double x, double) { return std::fabs(x); });
    case Instruction::larger:
      return each(lanes, y, a, b, [](double x, double z) { return x < z ? z : x; });
    case Instruction::sqrt:
      return each(lanes, y, a, b, [](double x, double) { return std::sqrt(x); });
    default:
      for (std::size_t i = 0; i < lanes; ++i) y[i] = applied(instruction, a[i], b[i], c[i]);
  }
}

}  // namespace

std::int64_t interpret_lanes(const Program& program, std::size_t uniform, std::size_t lanes, double* carried,
                             const double* varying, std::int64_t steps, bool* failed) {
  const std::size_t values = program.values(), operations = program.operations.size();
  std::vector<double> results(operations * lanes), constants(uniform * lanes), next(values * lanes);
  for (std::size_t c = 0; c < uniform; ++c) std::fill_n(&constants[c * lanes], lanes, program.constants[c]);
  const auto at = [&](const Operand& operand) -> const double* {
    switch (operand.kind) {
      case Operand::Kind::carried:
        return carried + operand.index * lanes;
      case Operand::Kind::result:
        return results.data() + operand.index * lanes;
      case Operand::Kind::constant:
        return operand.index < uniform ? constants.data() + operand.index * lanes
                                       : varying + (operand.index - uniform) * lanes;
      case Operand::Kind::none:
        break;
    }
    return nullptr;
  };
  std::int64_t step = 0;
  for (bool ended = false; step < steps && !ended; ++step) {
    for (std::size_t i = 0; i < operations; ++i) {
      const auto& operation = program.operations[i];
      const double *a = at(operation.a), *b = at(operation.b), *c = at(operation.c);
      apply(operation.instruction, lanes, &results[i * lanes], a, b ? b : a, c ? c : a);
    }
    for (const auto& check : program.checks) {
      const double *a = at(check.a), *b = at(check.b);
      for (std::size_t i = 0; i < lanes; ++i) failed[i] |= !holds(check.kind, a[i], b ? b[i] : a[i]);
    }
    for (std::size_t k = 0; k < values; ++k) std::copy_n(at(program.outputs[k]), lanes, &next[k * lanes]);
    std::copy(next.begin(), next.end(), carried);
    for (const std::uint32_t k : program.ends_at) {
      ended = ended || std::any_of(carried + k * lanes, carried + (k + 1) * lanes, [](double x) { return x != 0; });
    }
  }
  return step;
}

}  // namespace hamflow::native
