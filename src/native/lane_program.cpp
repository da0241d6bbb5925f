#include <algorithm>

#include "lanes.hpp"
#include "passes.hpp"

namespace hamflow::native {
namespace {

using Kind = Operand::Kind;

/// Turns constants that differ between members into carried values that never change, so that no pass folds them.
Program with_constants_carried(const Program& program, std::span<const bool> differs) {
  Program result = program;
  std::vector<std::uint32_t> value(differs.size());
  for (std::uint32_t c = 0; c < differs.size(); ++c) {
    if (!differs[c]) continue;
    value[c] = static_cast<std::uint32_t>(result.outputs.size());
    result.outputs.push_back({Kind::carried, value[c]});
  }
  const auto move = [&](Operand& operand) {
    if (operand.kind == Kind::constant && differs[operand.index]) operand = {Kind::carried, value[operand.index]};
  };
  for (auto& operation : result.operations) move(operation.a), move(operation.b), move(operation.c);
  for (Operand& output : result.outputs) move(output);
  for (auto& check : result.checks) move(check.a), move(check.b);
  return result;
}

}  // namespace

LaneProgram lane_program(const Program& program, std::span<const bool> differs) {
  const Program all = simplified(with_constants_carried(program, differs));
  const std::size_t values = program.values(), size = all.operations.size();
  std::vector<char> is_fixed(size);  // whether a result depends only on constants
  const auto fixed = [&](const Operand& operand) {
    return operand.kind == Kind::carried ? operand.index >= values
                                         : operand.kind != Kind::result || is_fixed[operand.index];
  };
  for (std::size_t i = 0; i < size; ++i)
    is_fixed[i] = fixed(all.operations[i].a) && fixed(all.operations[i].b) && fixed(all.operations[i].c);

  LaneProgram result;
  result.given = all.values() - values;
  result.uniform = all.constants.size();
  result.step.constants = all.constants;
  result.step.constants.resize(result.uniform + result.given);
  result.before.constants = all.constants;
  for (std::uint32_t j = 0; j < result.given; ++j) result.before.outputs.push_back({Kind::carried, j});

  std::vector<Operand> in_before(size), in_step(size);  // operands for fixed results, set when they are first needed
  const auto before = [&](Operand operand) {
    if (operand.kind == Kind::result) return in_before[operand.index];
    if (operand.kind == Kind::carried) operand.index -= static_cast<std::uint32_t>(values);
    return operand;
  };
  const auto step = [&](const Operand& operand) -> Operand {
    if (operand.kind == Kind::carried && operand.index >= values)
      return {Kind::constant, static_cast<std::uint32_t>(result.uniform + operand.index - values)};
    if (operand.kind != Kind::result) return operand;
    Operand& place = in_step[operand.index];
    if (place.kind == Kind::none) {  // a fixed result that is needed for the first time
      place = {Kind::constant, static_cast<std::uint32_t>(result.step.constants.size())};
      result.step.constants.push_back(0);
      result.before.outputs.push_back(in_before[operand.index]);
    }
    return place;
  };
  for (std::size_t i = 0; i < size; ++i) {
    const auto& [instruction, a, b, c] = all.operations[i];
    Program& part = is_fixed[i] ? result.before : result.step;
    if (is_fixed[i]) {
      part.operations.push_back({instruction, before(a), before(b), before(c)});
    } else {
      part.operations.push_back({instruction, step(a), step(b), step(c)});
    }
    (is_fixed[i] ? in_before : in_step)[i] = {Kind::result, static_cast<std::uint32_t>(part.operations.size() - 1)};
  }
  for (std::size_t k = 0; k < values; ++k) result.step.outputs.push_back(step(all.outputs[k]));
  for (const auto& check : all.checks) result.step.checks.push_back({check.kind, step(check.a), step(check.b)});
  result.step.ends_at = all.ends_at;
  return result;
}

Program interleaved(const LaneProgram& program, std::size_t registers, std::size_t chunk) {
  const auto count = static_cast<std::uint32_t>(registers), uniform = static_cast<std::uint32_t>(program.uniform);
  const Program& step = program.step;
  const std::size_t size = step.operations.size();
  std::vector<std::uint32_t> place(size * registers);  // operation i of register r is at index i registers + r
  std::uint32_t next = 0;
  for (std::size_t begin = 0; begin < size; begin += chunk) {
    for (std::size_t r = 0; r < registers; ++r) {
      for (std::size_t i = begin; i < std::min(size, begin + chunk); ++i) place[i * registers + r] = next++;
    }
  }
  std::uint32_t r = 0;
  const auto part = [&](const Operand& operand) -> Operand {
    switch (operand.kind) {
      case Kind::carried:
        return {Kind::carried, operand.index * count + r};
      case Kind::result:
        return {Kind::result, place[operand.index * registers + r]};
      case Kind::constant:
        return {Kind::constant,
                operand.index < uniform ? operand.index : uniform + (operand.index - uniform) * count + r};
      case Kind::none:
        break;
    }
    return operand;
  };
  Program result;
  result.constants.assign(step.constants.begin(), step.constants.begin() + uniform);
  result.constants.resize(uniform + (step.constants.size() - uniform) * registers);
  result.operations.resize(place.size());
  for (r = 0; r < count; ++r) {
    for (std::size_t i = 0; i < size; ++i) {
      const auto& [instruction, a, b, c] = step.operations[i];
      result.operations[place[i * registers + r]] = {instruction, part(a), part(b), part(c)};
    }
  }
  for (const auto& check : step.checks) {
    for (r = 0; r < count; ++r) result.checks.push_back({check.kind, part(check.a), part(check.b)});
  }
  for (const Operand& output : step.outputs) {
    for (r = 0; r < count; ++r) result.outputs.push_back(part(output));
  }
  for (const std::uint32_t value : step.ends_at) {
    for (r = 0; r < count; ++r) result.ends_at.push_back(value * count + r);
  }
  return result;
}

}  // namespace hamflow::native
