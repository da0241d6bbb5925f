#include "registers.hpp"

#include <algorithm>

#include "functions.hpp"
#include "moves.hpp"
#include "uses.hpp"

namespace hamflow::native {
namespace {

constexpr Place nowhere{};
constexpr Place reg(std::uint32_t r) { return {Place::Kind::reg, r}; }
constexpr std::uint64_t only(const Place& place) {  // the set with this register; empty if it is not a register
  return place.kind == Place::Kind::reg ? std::uint64_t{1} << place.index : 0;
}
constexpr Place home(std::uint32_t k) { return {Place::Kind::home, k}; }

class Allocator {
 public:
  Allocator(const Program& program, unsigned registers, StepsOfLoop steps)
      : program_(program),
        once_(steps == StepsOfLoop::one),
        events_(events_of(program)),
        end_(static_cast<std::uint32_t>(events_.size())),
        uses_(program, events_),
        values_(static_cast<std::uint32_t>(program.values())),
        in_register_(registers, never),
        registers_(uses_.count(), never),
        memory_(uses_.count()),
        output_(uses_.count(), never),
        is_dead_(uses_.count()),
        fixed_register_(values_, never) {
    for (std::uint32_t k = values_; k-- > 0;) {
      if (const std::uint32_t n = uses_.number(program.outputs[k]); n != never) output_[n] = k;
    }
    choose_fixed_registers();
  }

  PlacedProgram run() && {
    for (std::uint32_t k = 0; k < values_; ++k) {
      const std::uint32_t r = fixed_register_[k];
      if (r == never) {
        memory_[k] = home(k);
      } else {
        if (!once_ || uses_.next(k) != never) result_.entry.push_back({Line::Kind::move, {}, {}, reg(r), home(k), {}});
        result_.exit.push_back({Line::Kind::move, {}, {}, home(k), reg(r), {}});
        if (uses_.next(k) != never) bind(k, r);
      }
      if (uses_.next(k) == never) is_dead_[k] = true;
    }
    for (event_ = 0; event_ < end_; ++event_) {
      const auto [is_check, index] = events_[event_];
      if (is_check) {
        place_check(index);
      } else if (program_.operations[index].instruction == Instruction::cosine_of_both) {
        pass(program_.operations[index].a, {});  // the call for the sine has computed it, too
        after_line(program_.operations[index].a, {});
      } else if (is_call(program_.operations[index].instruction)) {
        place_call(program_.operations[index], values_ + index);
      } else {
        place_operation(program_.operations[index], values_ + index);
      }
    }
    close_step();
    return std::move(result_);
  }

 private:
  /// Chooses registers for carried values, those that are used earliest first. Two registers stay free for results.
  void choose_fixed_registers() {
    std::vector<std::uint32_t> order;
    for (std::uint32_t k = 0; k < values_; ++k) order.push_back(k);
    const auto is_kept = [&](std::uint32_t k) { return program_.outputs[k] == Operand{Operand::Kind::carried, k}; };
    if (once_) std::erase_if(order, is_kept);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t x, std::uint32_t y) {
      if (is_kept(x) != is_kept(y)) return is_kept(y);  // values that never change can stay in memory at no cost
      return uses_.next(x) < uses_.next(y);
    });
    const auto most = static_cast<std::uint32_t>(in_register_.size()) - 2;
    const auto count = static_cast<std::uint32_t>(order.size());
    for (std::uint32_t r = 0; r < std::min(most, count); ++r) fixed_register_[order[r]] = r;
  }

  void bind(std::uint32_t number, std::uint32_t r) {
    in_register_[r] = number;
    registers_[number] = r;
  }
  void unbind(std::uint32_t r) {
    if (in_register_[r] != never) registers_[in_register_[r]] = never;
    in_register_[r] = never;
  }

  Place place_of(const Operand& operand) const {
    if (operand.kind == Operand::Kind::none) return nowhere;
    if (operand.kind == Operand::Kind::constant) return {Place::Kind::constant, operand.index};
    const std::uint32_t n = uses_.number(operand);
    return registers_[n] != never ? reg(registers_[n]) : memory_[n];
  }

  void emit_move(const Place& to, const Place& from) {
    result_.body.push_back({Line::Kind::move, {}, {}, to, from, {}});
  }

  /// Chooses where a number is stored: in the home of its output, if the old value there is no longer needed, else on
  /// the stack.
  Place storage_for(std::uint32_t number) {
    if (number < values_) return home(number);
    if (const std::uint32_t k = output_[number]; k != never && is_dead_[k]) return home(k);
    return new_slot();
  }
  Place new_slot() {
    if (free_slots_.empty()) return {Place::Kind::slot, result_.slots++};
    const std::uint32_t slot = free_slots_.back();
    free_slots_.pop_back();
    return {Place::Kind::slot, slot};
  }
  void store(std::uint32_t number) {
    if (memory_[number] != nowhere) return;
    memory_[number] = storage_for(number);
    emit_move(memory_[number], reg(registers_[number]));
  }

  /// Returns the register with the latest next use, among those that are not in the set `pinned`.
  std::uint32_t register_to_free(std::uint64_t reserved_registers) const {
    std::uint32_t best = never;
    for (std::uint32_t r = 0; r < in_register_.size(); ++r) {
      if ((reserved_registers >> r & 1) != 0 || in_register_[r] == never) continue;
      if (best == never || distance(r) > distance(best)) best = r;
    }
    return best;
  }
  /// Compares next uses. If they are equal, a number that is in memory already comes first, because it needs no store.
  std::pair<std::uint32_t, bool> distance(std::uint32_t r) const {
    return {uses_.next(in_register_[r]), memory_[in_register_[r]] != nowhere};
  }
  std::uint32_t free_register(std::uint32_t wanted, std::uint64_t reserved_registers) const {
    const auto is_free = [&](std::uint32_t r) {
      return in_register_[r] == never && (reserved_registers >> r & 1) == 0;
    };
    if (wanted != never && is_free(wanted)) return wanted;
    for (auto r = static_cast<std::uint32_t>(in_register_.size()); r-- > 0;) {  // homes have the lowest numbers
      if (is_free(r)) return r;
    }
    return never;
  }
  std::uint32_t take_register(std::uint32_t wanted, std::uint64_t reserved_registers = 0) {
    std::uint32_t r = free_register(wanted, reserved_registers);
    if (r == never) {
      r = register_to_free(reserved_registers);
      store(in_register_[r]);
      unbind(r);
    }
    return r;
  }
  std::uint32_t wanted_for(std::uint32_t number) const {
    const std::uint32_t k = output_[number];
    return k == never ? never : fixed_register_[k];
  }

  /// Loads an operand from memory if it is used again, and if no number with an earlier use loses its register.
  void load_if_wanted(const Operand& operand, std::uint64_t reserved_registers) {
    const std::uint32_t n = uses_.number(operand);
    if (n == never || registers_[n] != never) return;
    const std::uint32_t again = uses_.next_after(n, event_);
    if (again == never || again == end_) return;
    if (free_register(never, reserved_registers) == never) {
      const std::uint32_t r = register_to_free(reserved_registers);
      if (uses_.next(in_register_[r]) <= again) return;
    }
    const std::uint32_t r = take_register(never, reserved_registers);
    emit_move(reg(r), memory_[n]);
    bind(n, r);
  }
  /// Returns a register that contains `a`.
  std::uint32_t first_in_register(const Operand& a, std::uint32_t wanted) {
    load_if_wanted(a, 0);
    const Place place = place_of(a);
    if (place.kind == Place::Kind::reg) return place.index;
    const std::uint32_t r = take_register(wanted);
    emit_move(reg(r), place);
    return r;
  }

  /// Marks operands as read. Operands without a later use leave their registers. Their memory becomes free only after
  /// the line (after_line), because a store before it must not overwrite what the line reads.
  void pass(const Operand& a, const Operand& b, const Operand& c = {}) {
    for (const Operand& operand : {a, b, c}) {
      const std::uint32_t n = uses_.number(operand);
      if (n == never) continue;
      uses_.pass(n, event_);
      if (uses_.next(n) == never && registers_[n] != never) unbind(registers_[n]);
    }
  }
  void after_line(const Operand& a, const Operand& b, const Operand& c = {}) {
    for (const Operand& operand : {a, b, c}) {
      if (const std::uint32_t n = uses_.number(operand); n != never) bury(n);
    }
  }
  void bury(std::uint32_t number) {
    if (uses_.next(number) != never || is_dead_[number]) return;
    is_dead_[number] = true;
    if (memory_[number].kind == Place::Kind::slot) free_slots_.push_back(memory_[number].index);
  }

  /// Returns the register of a and the place of b, for a line that reads both.
  std::pair<Place, Place> operands(const Operand& a, const Operand& b, std::uint32_t wanted) {
    const std::uint32_t first = first_in_register(a, wanted);
    if (b == a) return {reg(first), reg(first)};
    load_if_wanted(b, only(reg(first)));
    return {reg(first), place_of(b)};
  }

  void place_operation(const Program::Operation& operation, std::uint32_t number) {
    if (operation.instruction == Instruction::of_lane) return place_of_lane(operation, number);
    Operand a = operation.a, b = operation.b;
    const bool has_two = b.kind != Operand::Kind::none;
    if (operation.instruction == Instruction::larger) std::swap(a, b);
    if (is_commutative(operation.instruction) && place_of(a).kind != Place::Kind::reg &&
        (place_of(b).kind == Place::Kind::reg || a.kind == Operand::Kind::constant))
      std::swap(a, b);
    const std::uint32_t wanted = wanted_for(number);
    const auto [first, second] = operands(a, b, wanted);
    if (operation.c.kind != Operand::Kind::none) return place_fused(operation, number, first, second);
    pass(a, b);
    const std::uint32_t to = take_register(wanted);
    result_.body.push_back(
        {Line::Kind::operation, operation.instruction, {}, reg(to), first, has_two ? second : nowhere});
    after_line(a, b);
    if (uses_.next(number) != never) bind(number, to);
  }

  /// Places an of_lane operation, which reads the array of the caller.
  void place_of_lane(const Program::Operation& operation, std::uint32_t number) {
    pass(operation.a, {});
    const std::uint32_t to = take_register(wanted_for(number));
    result_.body.push_back({Line::Kind::operation,
                            operation.instruction,
                            {},
                            reg(to),
                            home(operation.a.index),
                            {Place::Kind::constant, operation.b.index}});
    after_line(operation.a, {});
    if (uses_.next(number) != never) bind(number, to);
  }

  /// Places a fused operation. Its result replaces c: in the register of c if c is not used later, else in a copy.
  void place_fused(const Program::Operation& operation, std::uint32_t number, const Place& first, const Place& second) {
    const auto& [instruction, a, b, c] = operation;
    const std::uint32_t n = uses_.number(c);
    const bool ends = n != never && registers_[n] != never && uses_.next_after(n, event_) == never && c != a && c != b;
    std::uint32_t to = ends ? registers_[n] : never;
    if (!ends) {
      to = take_register(wanted_for(number), only(first) | only(second));
      emit_move(reg(to), place_of(c));
    }
    pass(a, b, c);
    result_.body.push_back({Line::Kind::operation, instruction, {}, reg(to), first, second});
    after_line(a, b, c);
    if (uses_.next(number) != never) bind(number, to);
  }

  void place_check(std::uint32_t index) {
    const Program::Check& check = program_.checks[index];
    const auto [first, second] = operands(check.a, check.b, never);
    pass(check.a, check.b);
    const std::uint32_t spare = take_register(never, only(first));
    const bool has_two = check.b.kind != Operand::Kind::none;
    result_.body.push_back({Line::Kind::check, {}, check.kind, reg(spare), first, has_two ? second : nowhere, index});
    after_line(check.a, check.b);
  }

  void place_call(const Program::Operation& operation, std::uint32_t number) {
    const Place a = place_of(operation.a), b = place_of(operation.b);
    for (const Operand& operand : {operation.a, operation.b}) {
      if (const std::uint32_t n = uses_.number(operand); n != never) uses_.pass(n, event_);
    }
    for (std::uint32_t r = 0; r < in_register_.size(); ++r) {
      const std::uint32_t n = in_register_[r];
      if (n != never && uses_.next(n) != never) store(n);
    }
    for (std::uint32_t r = 0; r < in_register_.size(); ++r) unbind(r);
    std::vector<Move> moves{{a, reg(0)}};
    if (b != nowhere) moves.push_back({b, reg(1)});
    append_moves(result_.body, moves, 2, [this] { return new_slot(); });
    result_.body.push_back({Line::Kind::call, operation.instruction, {}, reg(0), reg(0), b == nowhere ? b : reg(1)});
    after_line(operation.a, operation.b);
    if (uses_.next(number) != never) bind(number, 0);
    if (operation.instruction == Instruction::sine_of_both && uses_.next(number + 1) != never) bind(number + 1, 1);
  }

  /// Moves every output to the place where the next step reads it.
  void close_step() {
    std::vector<Move> moves;
    for (std::uint32_t k = 0; k < values_; ++k) {
      const std::uint32_t n = uses_.number(program_.outputs[k]);
      const Place to = fixed_register_[k] != never ? reg(fixed_register_[k]) : home(k);
      if (n != never && memory_[n] == to) continue;
      moves.push_back({place_of(program_.outputs[k]), to});
    }
    append_moves(result_.body, std::move(moves), static_cast<std::uint32_t>(in_register_.size()) - 1,
                 [this] { return new_slot(); });
    for (const std::uint32_t k : program_.ends_at) {
      result_.ends_at.push_back(fixed_register_[k] != never ? reg(fixed_register_[k]) : home(k));
    }
  }

  const Program& program_;
  const bool once_;
  const std::vector<Event> events_;
  const std::uint32_t end_;
  Uses uses_;
  const std::uint32_t values_;
  std::vector<std::uint32_t> in_register_;  // the number in each register
  std::vector<std::uint32_t> registers_;    // the register of each number
  std::vector<Place> memory_;               // the place in memory of each number, or nowhere
  std::vector<std::uint32_t> output_;       // the first output that equals a number
  std::vector<char> is_dead_;
  std::vector<std::uint32_t> fixed_register_;  // the fixed register of each carried value, if it has one
  std::vector<std::uint32_t> free_slots_;
  std::uint32_t event_ = 0;
  PlacedProgram result_;
};

}  // namespace

PlacedProgram placed(const Program& program, unsigned registers, StepsOfLoop steps) {
  return Allocator(program, registers, steps).run();
}

}  // namespace hamflow::native
