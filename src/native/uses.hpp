// The events of a program in their order, and where each number is used next.
#pragma once

#include "hamflow/detail/numerics/program.hpp"

namespace hamflow::native {

constexpr std::uint32_t never = 0xffffffff;

/// One operation or one check.
struct Event {
  bool is_check;
  std::uint32_t index;
};

/// Every operation, and every check as soon as what it looks at is known.
std::vector<Event> events_of(const Program& program);

/// Numbers by one index: what is carried, then results.
class Uses {
 public:
  Uses(const Program& program, const std::vector<Event>& events);

  /// `never` for constants.
  std::uint32_t number(const Operand& operand) const {
    if (operand.kind == Operand::Kind::carried) return operand.index;
    if (operand.kind == Operand::Kind::result) return values_ + operand.index;
    return never;
  }
  std::uint32_t count() const { return static_cast<std::uint32_t>(next_.size()); }
  /// The event that uses the number next: events.size() as an output only, `never` if nothing does.
  std::uint32_t next(std::uint32_t number) const { return next_[number]; }
  /// The use behind `event`.
  std::uint32_t next_after(std::uint32_t number, std::uint32_t event) const;
  /// Goes past `event`, which uses the number (or does not).
  void pass(std::uint32_t number, std::uint32_t event);

 private:
  std::uint32_t values_;
  std::vector<std::uint32_t> uses_;             // of all numbers, ascending for each
  std::vector<std::uint32_t> at_, end_, next_;  // of each number: its next in uses_, its last there, when
};

}  // namespace hamflow::native
