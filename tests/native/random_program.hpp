// Programs drawn at random, for comparing two ways of running them.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "hamflow/core/counter_random.hpp"
#include "native/functions.hpp"

namespace hamflow {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_(seed) {}
  std::uint64_t bits() { return counter_bits(seed_, ++count_); }
  std::uint32_t below(std::size_t n) { return static_cast<std::uint32_t>(bits() % n); }
  bool chance(double p) { return uniform() < p; }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double special() {
    constexpr double inf = std::numeric_limits<double>::infinity(), tiny = std::numeric_limits<double>::denorm_min();
    const double numbers[] = {0,
                              0,
                              1,
                              2,
                              0.5,
                              0.125,
                              inf,
                              std::nan(""),
                              tiny,
                              3 * tiny,
                              0x1p-1022,
                              0x1p-1023,
                              0x1p1023,
                              3,
                              0x1.fffffffffffffp1023};
    const double x = numbers[below(std::size(numbers))];
    return chance(0.5) ? -x : x;
  }

 private:
  std::uint64_t seed_, count_ = 0;
};

struct RandomCase {
  Program program;
  std::vector<double> start;
  std::int64_t steps = 0;
};

/// What decides the form of a program.
struct RandomForm {
  std::size_t values, operations, constants;
  double calls;    // share of the operations that are functions of the library
  double checks;   // how many for each operation
  double recent;   // share of operands that are among the last eight results: few numbers live at a time
  double special;  // share of numbers that are zero, infinite, NaN, subnormal, powers of two
  bool ordinary;   // results are, for the most part
};

inline RandomForm random_form(Draw& draw, std::size_t most_operations) {
  RandomForm form{};
  const double share = std::pow(draw.uniform(), 6);  // most are small
  form.operations = static_cast<std::size_t>(static_cast<double>(most_operations) * share);
  form.values = draw.chance(0.1) ? draw.below(60) : draw.below(12);
  form.constants = draw.below(8);
  form.calls = draw.chance(0.7) ? 0 : draw.chance(0.5) ? 0.02 : 0.3;
  form.checks = draw.chance(0.5) ? 0 : 0.05;
  form.recent = draw.uniform();
  form.special = draw.chance(0.5) ? 0 : 0.2;
  form.ordinary = true;
  return form;
}

/// A few operations on special numbers: where a rule that does not hold for all of them would show.
inline RandomForm special_form(Draw& draw) {
  RandomForm form{};
  form.values = 1 + draw.below(6);
  form.operations = 1 + draw.below(12);
  form.constants = draw.below(6);
  form.checks = 0.05;
  form.recent = draw.uniform();
  form.special = 0.8;
  return form;
}

/// A program and what to run it on. Numbers are followed as the program is drawn, and most operations that would leave
/// the ordinary ones are drawn again, so that what is compared is not all NaN.
inline RandomCase random_case(Draw& draw, const RandomForm& form) {
  using Kind = Operand::Kind;
  RandomCase result;
  Program& program = result.program;
  const auto number = [&] { return draw.chance(form.special) ? draw.special() : 4 * draw.uniform() - 2; };
  for (std::size_t k = 0; k < form.values; ++k) result.start.push_back(number());
  for (std::size_t k = 0; k < form.constants; ++k) program.constants.push_back(number());
  std::vector<double> results;
  const auto operand = [&]() -> Operand {
    const std::size_t all = form.values + form.constants + results.size();
    if (!results.empty() && draw.chance(form.recent)) {
      const std::size_t last = std::min<std::size_t>(8, results.size());
      return {Kind::result, static_cast<std::uint32_t>(results.size() - 1 - draw.below(last))};
    }
    const std::uint32_t i = draw.below(all);
    if (i < form.values) return {Kind::carried, i};
    if (i < form.values + form.constants) return {Kind::constant, static_cast<std::uint32_t>(i - form.values)};
    return {Kind::result, static_cast<std::uint32_t>(i - form.values - form.constants)};
  };
  const auto value = [&](const Operand& x) {
    switch (x.kind) {
      case Kind::carried:
        return result.start[x.index];
      case Kind::constant:
        return program.constants[x.index];
      case Kind::result:
        return results[x.index];
      case Kind::none:
        break;
    }
    return 0.0;
  };
  const bool has_numbers = form.values + form.constants > 0;
  for (std::size_t i = 0; has_numbers && i < form.operations; ++i) {
    for (int attempt = form.ordinary ? 0 : 29; attempt < 30; ++attempt) {
      static constexpr Instruction arithmetic[] = {Instruction::add,    Instruction::subtract, Instruction::multiply,
                                                   Instruction::divide, Instruction::negate,   Instruction::abs,
                                                   Instruction::larger, Instruction::sqrt,     Instruction::choose};
#define HAMFLOW_ENTRY(name, symmetry, rule, series) Instruction::name,
      static constexpr Instruction calls[] = {HAMFLOW_FUNCTIONS(HAMFLOW_ENTRY) Instruction::atan2, Instruction::power};
#undef HAMFLOW_ENTRY
      const Instruction instruction =
          draw.chance(form.calls) ? calls[draw.below(std::size(calls))] : arithmetic[draw.below(std::size(arithmetic))];
      const int arity = native::arity(instruction);
      const Operand a = operand(), b = arity > 1 ? operand() : Operand{}, c = arity > 2 ? operand() : Operand{};
      const double x = native::applied(instruction, value(a), value(b), value(c));
      const bool ordinary = std::isfinite(x) && std::fabs(x) < 1e9 && std::fabs(x) > 1e-9;
      if (!ordinary && attempt < 29 && !draw.chance(0.02)) continue;
      program.operations.push_back({instruction, a, b, c});
      results.push_back(x);
      break;
    }
    if (!draw.chance(form.checks)) continue;
    for (int attempt = 0; attempt < 10; ++attempt) {
      const auto kind = static_cast<Program::Check::Kind>(draw.below(5));
      const Program::Check check{kind, operand(), kind == Program::Check::Kind::finite ? Operand{} : operand()};
      if (!native::holds(kind, value(check.a), value(check.b)) && !draw.chance(0.01)) continue;
      program.checks.push_back(check);
      break;
    }
  }
  for (std::size_t k = 0; k < form.values; ++k) {  // some are kept, exchanged or constant; most are computed late
    const auto size = static_cast<std::uint32_t>(results.size());
    if (draw.chance(0.1)) {
      program.outputs.push_back({Kind::carried, static_cast<std::uint32_t>(k)});
    } else if (draw.chance(0.2) || size == 0) {
      program.outputs.push_back({Kind::carried, draw.below(form.values)});
    } else if (draw.chance(0.8)) {
      program.outputs.push_back({Kind::result, size - 1 - draw.below(std::min<std::size_t>(size, 2 * form.values))});
    } else {
      program.outputs.push_back(operand());
    }
  }
  if (form.values > 0 && draw.chance(0.1)) program.ends_at.push_back(draw.below(form.values));
  const std::int64_t steps[] = {0, 1, 1, 2, 2, 3, 5, 17};
  result.steps = steps[draw.below(std::size(steps))];
  return result;
}

/// Equal bits, but for NaN's payloads.
inline bool same_bits(double a, double b) {
  return a == b ? std::signbit(a) == std::signbit(b) : std::isnan(a) && std::isnan(b);
}

}  // namespace hamflow
