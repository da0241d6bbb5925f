// The order of operations and checks of a program (events), and the next use of each number.
#pragma once

#include "hamflow/detail/numerics/program.hpp"

namespace hamflow::native {

constexpr std::uint32_t never = 0xffffffff;

/// An operation or a check.
struct Event {
  bool is_check;
  std::uint32_t index;
};

/// Lists all operations in order, with each check as soon as its numbers are known.
std::vector<Event> events_of(const Program& program);

/// The uses of numbers. Numbers have one index: carried values first, then results.
class Uses {
 public:
  Uses(const Program& program, const std::vector<Event>& events);

  /// Returns the index of an operand; `never` for constants.
  std::uint32_t number(const Operand& operand) const {
    if (operand.kind == Operand::Kind::carried) return operand.index;
    if (operand.kind == Operand::Kind::result) return values_ + operand.index;
    return never;
  }
  std::uint32_t count() const { return static_cast<std::uint32_t>(next_.size()); }
  /// Returns the next event that uses the number: events.size() if it is only an output, `never` if it is not used.
  std::uint32_t next(std::uint32_t number) const { return next_[number]; }
  /// Returns the next use after `event`.
  std::uint32_t next_after(std::uint32_t number, std::uint32_t event) const;
  /// Advances past `event`, whether it uses the number or not.
  void pass(std::uint32_t number, std::uint32_t event);

 private:
  std::uint32_t values_;
  std::vector<std::uint32_t> uses_;  // the events that use each number, ascending, one number after the other
  std::vector<std::uint32_t> at_, end_, next_;  // for each number: index of its next use, end of its uses, next event
};

}  // namespace hamflow::native
