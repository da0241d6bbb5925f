// Assembles the lines of a placed program as vector instructions of AVX2 or AVX-512. A place holds one vector register
// of numbers. Check c belongs to the register c mod registers of its value.
#include <stdexcept>

#include "functions.hpp"
#include "lanes.hpp"
#include "loop_assembler.hpp"

namespace hamflow::native {
namespace {

using namespace asmjit;  // NOLINT

// Functions of the C library are called lane by lane.
template <std::size_t width>
void call_of_one(FunctionOfOne f, double* y, const double* a) {
  for (std::size_t i = 0; i < width; ++i) y[i] = f(a[i]);
}
template <std::size_t width>
void call_of_two(FunctionOfTwo f, double* y, const double* a, const double* b) {
  for (std::size_t i = 0; i < width; ++i) y[i] = f(a[i], b[i]);
}
/// Writes the sine to y and the cosine to z.
template <std::size_t width>
void call_of_both(FunctionOfOne, double* y, const double* a, double* z) {
  for (std::size_t i = 0; i < width; ++i) {
    const SineAndCosine both = sine_and_cosine(a[i]);
    y[i] = both.sine;
    z[i] = both.cosine;
  }
}

/// @tparam Register Ymm or Zmm
template <class Register>
class LaneAssembler final : public LoopAssembler {
  static constexpr bool wide = std::is_same_v<Register, x86::Zmm>;
  static constexpr std::size_t width = wide ? 8 : 4, bytes = 8 * width;
  // Arguments of a call, at rsp: the result, the operand, and the second operand or second result.
  static constexpr std::size_t arguments = 3 * bytes;

 public:
  LaneAssembler(const PlacedProgram& program, const std::vector<double>& constants, std::size_t uniform,
                std::size_t registers, CodeHolder& code)
      : LoopAssembler(program, arguments + bytes * program.slots, code),
        constants_(constants),
        uniform_(uniform),
        registers_(registers) {}

 private:
  static Register reg(const Place& place) { return Register(place.index); }
  static std::int32_t offset(std::size_t index) { return static_cast<std::int32_t>(bytes * index); }

  bool is_uniform(const Place& place) const { return place.kind == Place::Kind::constant && place.index < uniform_; }

  x86::Mem memory(const Place& place) const {
    switch (place.kind) {
      case Place::Kind::home:
        return x86::ptr(x86::rbx, offset(place.index));
      case Place::Kind::slot:
        return x86::ptr(x86::rsp, static_cast<std::int32_t>(arguments) + offset(place.index));
      case Place::Kind::constant:
        if (!is_uniform(place)) return x86::ptr(x86::r13, offset(place.index - uniform_));
        return in_table(place.index + table_head);
      default:
        throw std::logic_error("machine code: a place that is not in memory");
    }
  }
  /// A number of the table for all lanes. AVX-512 broadcasts it; for AVX2 the table contains it once for each lane.
  x86::Mem in_table(std::size_t index) const {
    if constexpr (wide) return x86::ptr(table_, static_cast<std::int32_t>(8 * index))._1to8();
    return x86::ptr(table_, offset(index));
  }

  template <class Emit>
  void with(const Place& place, const Emit& emit) {
    if (place.kind == Place::Kind::reg) {
      emit(reg(place));
    } else {
      emit(memory(place));
    }
  }

  void move(const Line& line) override {
    if (line.to.kind != Place::Kind::reg) {
      a_.vmovupd(memory(line.to), reg(line.a));
    } else if (line.a.kind == Place::Kind::reg) {
      a_.vmovapd(reg(line.to), reg(line.a));
    } else if (wide && is_uniform(line.a)) {
      a_.vbroadcastsd(reg(line.to), x86::qword_ptr(table_, static_cast<std::int32_t>(8 * (line.a.index + table_head))));
    } else {
      a_.vmovupd(reg(line.to), memory(line.a));
    }
  }

  /// Emits a selection. Consecutive lines that choose by the same number reuse the mask.
  void choose(const Line& line) {
    const Register to = reg(line.to), mask = Register(15);  // only AVX2 uses register 15 as a mask
    if (chosen_by_ != line.a) {
      constexpr int greater = 0x1e;  // quiet
      if constexpr (wide) {
        a_.vcmppd(x86::k2, reg(line.a), in_table(2), Imm(greater));
      } else {
        a_.vcmppd(mask, reg(line.a), in_table(2), Imm(greater));
      }
      chosen_by_ = line.to == line.a ? Place{} : line.a;
    }
    with(line.b, [&](const auto& b) {
      if constexpr (wide) {
        a_.k(x86::k2).vblendmpd(to, to, b);
      } else {
        a_.vblendvpd(to, to, b, mask);
      }
    });
  }
  void before(const Line& next) override {
    if (next.kind == Line::Kind::call || next.to == chosen_by_) chosen_by_ = {};
  }

  void operation(const Line& line) override {
    if (line.instruction == Instruction::choose) return choose(line);
    const Register to = reg(line.to), a = reg(line.a);
    switch (line.instruction) {
      case Instruction::of_lane: {
        const std::size_t value = line.a.index / registers_ * registers_;  // the first register of the value
        const auto lane = static_cast<std::int32_t>(constants_[line.b.index]);
        a_.vbroadcastsd(to, x86::qword_ptr(x86::rbx, offset(value) + 8 * lane));
        return;
      }
      case Instruction::add:
        return with(line.b, [&](const auto& b) { a_.vaddpd(to, a, b); });
      case Instruction::subtract:
        return with(line.b, [&](const auto& b) { a_.vsubpd(to, a, b); });
      case Instruction::multiply:
        return with(line.b, [&](const auto& b) { a_.vmulpd(to, a, b); });
      case Instruction::divide:
        return with(line.b, [&](const auto& b) { a_.vdivpd(to, a, b); });
      case Instruction::larger:  // gives the second operand if they are equal or one is NaN
        return with(line.b, [&](const auto& b) { a_.vmaxpd(to, a, b); });
      case Instruction::negate:
        a_.vxorpd(to, a, in_table(0));
        return;
      case Instruction::abs:
        a_.vandpd(to, a, in_table(1));
        return;
      case Instruction::sqrt:
        a_.vsqrtpd(to, a);
        return;
      default:
        throw std::logic_error("machine code: an instruction that is a call");
    }
  }

  void call(Instruction instruction) override {
    const FunctionOfOne one = function_of_one(instruction);
    const bool both = instruction == Instruction::sine_of_both;
    const auto address = [](auto* f) { return Imm(reinterpret_cast<std::uintptr_t>(f)); };
    a_.vmovupd(x86::ptr(x86::rsp, offset(1)), Register(0));
    if (!one) a_.vmovupd(x86::ptr(x86::rsp, offset(2)), Register(1));
    leave_lanes();
    a_.mov(x86::rdi, one ? address(one) : address(function_of_two(instruction)));
    a_.mov(x86::rsi, x86::rsp);
    a_.lea(x86::rdx, x86::ptr(x86::rsp, offset(1)));
    a_.lea(x86::rcx, x86::ptr(x86::rsp, offset(2)));
    a_.mov(x86::rax, both  ? address(&call_of_both<width>)
                     : one ? address(&call_of_one<width>)
                           : address(&call_of_two<width>));
    a_.call(x86::rax);
    gather(0, offset(0));
    if (both) gather(1, offset(2));
  }

  /// Loads a register from the numbers at rsp + `from`, one at a time. A load of the whole register could not be
  /// forwarded from the narrower stores, and would wait for all of them. Registers 2 to 4 are free after a call.
  void gather(std::uint32_t to, std::int32_t from) {
    const std::uint32_t parts[] = {to, 2, 3, 4};
    const auto number = [&](std::size_t i) {
      return x86::qword_ptr(x86::rsp, from + static_cast<std::int32_t>(8 * i));
    };
    for (std::uint32_t pair = 0; pair < width / 2; ++pair) {
      const x86::Xmm part = x86::xmm(parts[pair]);
      a_.vmovsd(part, number(2 * pair));
      a_.vmovhpd(part, part, number(2 * pair + 1));
    }
    a_.vinsertf128(x86::ymm(to), x86::ymm(to), x86::xmm2, 1);
    if constexpr (wide) {
      a_.vinsertf128(x86::ymm3, x86::ymm3, x86::xmm4, 1);
      a_.vinsertf64x4(x86::zmm(to), x86::zmm(to), x86::ymm3, 1);
    }
  }

  /// Clears the upper halves of registers, because SSE code of the caller is slow while they are in use.
  void leave_lanes() override { a_.vzeroupper(); }

  void check(const Line& line) override {
    using Check = Program::Check::Kind;
    enum Predicate { equal = 0x00, unordered = 0x03, unequal = 0x04, less = 0x11, not_less = 0x15 };  // quiet
    const Register a = reg(line.a), spare = reg(line.to);
    switch (line.check) {  // computes the lanes in which the check fails
      case Check::finite:  // x - x is NaN if x is not finite
        a_.vsubpd(spare, a, a);
        return fail(line, spare, spare, unordered);
      case Check::equal:
        return with(line.b, [&](const auto& b) { fail(line, a, b, unequal); });
      case Check::unequal:
        return with(line.b, [&](const auto& b) { fail(line, a, b, equal); });
      case Check::less:
        return with(line.b, [&](const auto& b) { fail(line, a, b, not_less); });
      case Check::not_less:
        return with(line.b, [&](const auto& b) { fail(line, a, b, less); });
    }
  }
  template <class B>
  void fail(const Line& line, const Register& a, const B& b, int predicate) {
    if constexpr (wide) {
      a_.vcmppd(x86::k1, a, b, Imm(predicate));
      a_.kmovb(x86::eax, x86::k1);
    } else {
      a_.vcmppd(reg(line.to), a, b, Imm(predicate));
      a_.vmovmskpd(x86::eax, reg(line.to));
    }
    a_.or_(x86::dword_ptr(x86::r14, static_cast<std::int32_t>(8 * (line.index % registers_))), x86::eax);
  }

  void leave_unless_zero(const Place& place, const Label& after) override {
    constexpr int unequal = 0x04;          // also true for NaN
    if (place.kind != Place::Kind::reg) {  // no register is free
      for (std::int32_t lane = 0; lane < static_cast<std::int32_t>(width); ++lane) {
        const x86::Mem number = x86::qword_ptr(x86::rbx, offset(place.index) + 8 * lane);
        if (lane == 0) {
          a_.mov(x86::rax, number);
        } else {
          a_.or_(x86::rax, number);
        }
      }
      a_.add(x86::rax, x86::rax);  // without the sign of a zero
    } else if constexpr (wide) {
      a_.vcmppd(x86::k1, reg(place), in_table(2), Imm(unequal));
      a_.kortestw(x86::k1, x86::k1);
    } else {
      a_.vcmppd(Register(15), reg(place), in_table(2), Imm(unequal));
      a_.vptest(Register(15), Register(15));
    }
    a_.jnz(after);
  }

  static constexpr std::uint32_t table_head = 3;  // entries of the table before the constants
  void embed_table() override {
    constexpr std::uint64_t sign = 1ull << 63;
    std::vector<std::uint64_t> words;
    const auto add = [&](std::uint64_t word) { words.insert(words.end(), wide ? 1 : width, word); };
    add(sign);
    add(~sign);
    add(0);
    for (std::size_t c = 0; c < uniform_; ++c) add(std::bit_cast<std::uint64_t>(constants_[c]));
    embed(words);
  }

  const std::vector<double>& constants_;
  std::size_t uniform_, registers_;
  Place chosen_by_{};  // the number that the mask tests
};

}  // namespace

unsigned lane_registers(LaneSet lanes) {
  const unsigned scalar = scalar_registers();  // 32 with AVX-512
  if (lanes == LaneSet::avx512) return scalar == 32 ? 32 : 0;
  return lanes == LaneSet::avx2 && scalar > 0 && CpuInfo::host().features().x86().hasAVX2() ? 16 : 0;
}

std::unique_ptr<const Function> assembled_lanes(const PlacedProgram& program, const std::vector<double>& constants,
                                                std::size_t uniform, std::size_t registers, LaneSet lanes) {
  if (lanes == LaneSet::avx512) return assembled_by<LaneAssembler<x86::Zmm>>(program, constants, uniform, registers);
  return assembled_by<LaneAssembler<x86::Ymm>>(program, constants, uniform, registers);
}

}  // namespace hamflow::native
