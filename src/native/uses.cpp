#include "uses.hpp"

#include <algorithm>

namespace hamflow::native {

std::vector<Event> events_of(const Program& program) {
  const auto size = static_cast<std::uint32_t>(program.operations.size());
  std::vector<std::vector<std::uint32_t>> checks(size + 1);  // checks that become possible before each operation
  for (std::uint32_t c = 0; c < program.checks.size(); ++c) {
    std::uint32_t at = 0;
    for (const Operand& operand : {program.checks[c].a, program.checks[c].b}) {
      if (operand.kind == Operand::Kind::result) at = std::max(at, operand.index + 1);
    }
    checks[at].push_back(c);
  }
  std::vector<Event> events;
  events.reserve(size + program.checks.size());
  for (std::uint32_t i = 0; i <= size; ++i) {
    for (const std::uint32_t c : checks[i]) events.push_back({true, c});
    if (i < size) events.push_back({false, i});
  }
  return events;
}

Uses::Uses(const Program& program, const std::vector<Event>& events)
    : values_(static_cast<std::uint32_t>(program.values())) {
  const std::size_t numbers = values_ + program.operations.size();
  const auto end = static_cast<std::uint32_t>(events.size());
  const auto each = [&](const auto& visit) {  // calls visit(number, event) with ascending events
    const auto one = [&](const Operand& operand, std::uint32_t event) {
      if (const std::uint32_t n = number(operand); n != never) visit(n, event);
    };
    for (std::uint32_t e = 0; e < end; ++e) {
      const std::uint32_t i = events[e].index;
      one(events[e].is_check ? program.checks[i].a : program.operations[i].a, e);
      one(events[e].is_check ? program.checks[i].b : program.operations[i].b, e);
      if (!events[e].is_check) one(program.operations[i].c, e);
    }
    for (const Operand& output : program.outputs) one(output, end);
  };
  std::vector<std::uint32_t> starts(numbers + 1);
  each([&](std::uint32_t n, std::uint32_t) { ++starts[n + 1]; });
  for (std::size_t n = 0; n < numbers; ++n) starts[n + 1] += starts[n];
  uses_.resize(starts.back());
  at_.assign(starts.begin(), starts.end() - 1);
  end_ = at_;
  each([&](std::uint32_t n, std::uint32_t event) { uses_[end_[n]++] = event; });
  next_.resize(numbers);
  for (std::size_t n = 0; n < numbers; ++n) next_[n] = at_[n] < end_[n] ? uses_[at_[n]] : never;
}

std::uint32_t Uses::next_after(std::uint32_t number, std::uint32_t event) const {
  for (std::uint32_t at = at_[number]; at < end_[number]; ++at) {
    if (uses_[at] > event) return uses_[at];
  }
  return never;
}

void Uses::pass(std::uint32_t number, std::uint32_t event) {
  while (at_[number] < end_[number] && uses_[at_[number]] <= event) ++at_[number];
  next_[number] = at_[number] < end_[number] ? uses_[at_[number]] : never;
}

}  // namespace hamflow::native
