#include <algorithm>

#include "functions.hpp"
#include "passes.hpp"

namespace hamflow::native {
namespace {

using Kind = Operand::Kind;

/// Approximate cycles until a result can be used on current processors. It only matters which chains are long.
int latency(Instruction instruction) {
  switch (instruction) {
    case Instruction::add:
    case Instruction::subtract:
    case Instruction::multiply:
      return 4;
    case Instruction::negate:
    case Instruction::abs:
    case Instruction::larger:
    case Instruction::choose:
      return 1;
    case Instruction::divide:
      return 13;
    case Instruction::sqrt:
      return 20;
    default:
      return 60;
  }
}

/// Computes for every operation the cycles to the end of the longest chain that begins with it. A chain continues in
/// the next step through an output, so a second pass adds what follows there.
std::vector<int> heights(const Program& program) {
  const std::size_t size = program.operations.size();
  std::vector<int> height(size), of_carried(program.values());
  for (int round = 0; round < 2; ++round) {
    std::vector<int> tail(size), first(program.values());
    const auto need = [&](const Operand& operand, int cycles) {
      if (operand.kind == Kind::result) tail[operand.index] = std::max(tail[operand.index], cycles);
      if (operand.kind == Kind::carried) first[operand.index] = std::max(first[operand.index], cycles);
    };
    for (std::size_t k = 0; k < program.values(); ++k) need(program.outputs[k], of_carried[k]);
    for (std::size_t i = size; i-- > 0;) {
      const auto& operation = program.operations[i];
      height[i] = tail[i] + latency(operation.instruction);
      need(operation.a, height[i]);
      need(operation.b, height[i]);
      need(operation.c, height[i]);
    }
    of_carried = first;
  }
  return height;
}

}  // namespace

Program scheduled(const Program& program, std::size_t window) {
  constexpr int width = 4;  // operations per cycle
  const std::size_t size = program.operations.size();
  const std::vector<int> height = heights(program);
  constexpr int unknown = std::numeric_limits<int>::max();
  std::vector<int> ready(size, unknown);  // the cycle in which a result is available
  std::vector<std::size_t> candidates, order;
  order.reserve(size);
  std::size_t entered = 0;
  for (int cycle = 0, issued = 0; order.size() < size;) {
    while (entered < size && candidates.size() < window) candidates.push_back(entered++);
    const auto arrival = [&](const Operand& operand) {
      return operand.kind == Kind::result ? ready[operand.index] : 0;
    };
    std::size_t best = candidates.size();
    int soonest = unknown;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      const auto& operation = program.operations[candidates[c]];
      const int at = std::max({arrival(operation.a), arrival(operation.b), arrival(operation.c)});
      soonest = std::min(soonest, at);
      if (at <= cycle && (best == candidates.size() || height[candidates[c]] > height[candidates[best]])) best = c;
    }
    if (best == candidates.size() || issued == width) {  // the oldest candidate gets its operands in a later cycle
      cycle = best == candidates.size() ? soonest : cycle + 1;
      issued = 0;
      continue;
    }
    const std::size_t chosen = candidates[best];
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(best));
    ready[chosen] = cycle + latency(program.operations[chosen].instruction);
    order.push_back(chosen);
    ++issued;
  }

  Program result = program;
  std::vector<std::uint32_t> place(size);
  for (std::size_t i = 0; i < size; ++i) place[order[i]] = static_cast<std::uint32_t>(i);
  const auto move = [&](Operand& operand) {
    if (operand.kind == Kind::result) operand.index = place[operand.index];
  };
  for (std::size_t i = 0; i < size; ++i) {
    result.operations[i] = program.operations[order[i]];
    move(result.operations[i].a);
    move(result.operations[i].b);
    move(result.operations[i].c);
  }
  for (Operand& output : result.outputs) move(output);
  for (auto& check : result.checks) move(check.a), move(check.b);
  return result;
}

}  // namespace hamflow::native
