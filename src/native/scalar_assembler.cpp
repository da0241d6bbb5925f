// Assembles the lines of a placed program as scalar AVX instructions.
#include <algorithm>
#include <stdexcept>

#include "functions.hpp"
#include "loop_assembler.hpp"

namespace hamflow::native {
namespace {

using namespace asmjit;  // NOLINT

class ScalarAssembler final : public LoopAssembler {
 public:
  ScalarAssembler(const PlacedProgram& program, const std::vector<double>& constants, CodeHolder& code)
      : LoopAssembler(program, 8 * program.slots, code), constants_(constants) {}

 private:
  static x86::Xmm xmm(const Place& place) { return x86::xmm(place.index); }
  x86::Mem memory(const Place& place) const {
    const auto offset = static_cast<std::int32_t>(8 * place.index);
    switch (place.kind) {
      case Place::Kind::home:
        return x86::qword_ptr(x86::rbx, offset);
      case Place::Kind::slot:
        return x86::qword_ptr(x86::rsp, offset);
      case Place::Kind::constant:
        return x86::qword_ptr(table_, masks + offset);
      default:
        throw std::logic_error("machine code: a place that is not in memory");
    }
  }

  /// Emits an instruction whose operand is in a register or in memory.
  template <class Emit>
  void with(const Place& place, const Emit& emit) {
    if (place.kind == Place::Kind::reg) {
      emit(xmm(place));
    } else {
      emit(memory(place));
    }
  }

  void move(const Line& line) override {
    if (line.to.kind != Place::Kind::reg) {
      a_.vmovsd(memory(line.to), xmm(line.a));
    } else if (line.a.kind == Place::Kind::reg) {
      a_.vmovapd(xmm(line.to), xmm(line.a));
    } else {
      a_.vmovsd(xmm(line.to), memory(line.a));
    }
  }

  /// Emits a branch, which the processor predicts well because one side is rare. Consecutive lines that choose by the
  /// same number share the branch.
  void choose(const Line& line) {
    if (chosen_by_ != line.a) {
      close();
      unchanged_ = a_.newLabel();
      a_.vucomisd(xmm(line.a), x86::qword_ptr(table_, zero));
      a_.jbe(unchanged_);  // also taken for NaN
      chosen_by_ = line.a;
    }
    move({Line::Kind::move, {}, {}, line.to, line.b, {}});
    if (line.to == line.a) close();
  }
  void before(const Line& next) override {
    if (next.kind != Line::Kind::operation || next.instruction != Instruction::choose) close();
  }
  void close() {
    if (chosen_by_ != Place{}) a_.bind(unchanged_);
    chosen_by_ = {};
  }

  void operation(const Line& line) override {
    if (line.instruction == Instruction::choose) return choose(line);
    const x86::Xmm to = xmm(line.to), a = xmm(line.a);
    switch (line.instruction) {
      case Instruction::add:
        return with(line.b, [&](const auto& b) { a_.vaddsd(to, a, b); });
      case Instruction::subtract:
        return with(line.b, [&](const auto& b) { a_.vsubsd(to, a, b); });
      case Instruction::multiply:
        return with(line.b, [&](const auto& b) { a_.vmulsd(to, a, b); });
      case Instruction::divide:
        return with(line.b, [&](const auto& b) { a_.vdivsd(to, a, b); });
      case Instruction::larger:  // gives the second operand if they are equal or one is NaN
        return with(line.b, [&](const auto& b) { a_.vmaxsd(to, a, b); });
      case Instruction::negate:
        a_.vxorpd(to, a, x86::ptr(table_, sign_mask));
        return;
      case Instruction::abs:
        a_.vandpd(to, a, x86::ptr(table_, magnitude_mask));
        return;
      case Instruction::sqrt:
        a_.vsqrtsd(to, a, a);  // takes the upper half from a, too, so that it does not wait for the old `to`
        return;
      default:
        throw std::logic_error("machine code: an instruction that is a call");
    }
  }

  void call(Instruction instruction) override {
    const auto one = function_of_one(instruction);
    a_.mov(x86::rax, Imm(instruction == Instruction::sine_of_both ? reinterpret_cast<std::uintptr_t>(sine_and_cosine)
                         : one                                    ? reinterpret_cast<std::uintptr_t>(one)
                               : reinterpret_cast<std::uintptr_t>(function_of_two(instruction))));
    a_.call(x86::rax);
  }

  void check(const Line& line) override {
    using Check = Program::Check::Kind;
    const x86::Xmm a = xmm(line.a);
    if (line.check == Check::finite) {  // x - x is NaN if x is not finite
      a_.vsubsd(xmm(line.to), a, a);
      a_.vucomisd(xmm(line.to), xmm(line.to));
      a_.jp(failed_);
      return;
    }
    with(line.b, [&](const auto& b) { a_.vucomisd(a, b); });
    const Label holds = a_.newLabel();
    switch (line.check) {  // a comparison with NaN sets the parity, zero and carry flags
      case Check::equal:
        a_.jp(failed_);
        a_.jne(failed_);
        break;
      case Check::unequal:
        a_.jp(holds);
        a_.je(failed_);
        break;
      case Check::less:
        a_.jp(failed_);
        a_.jae(failed_);
        break;
      case Check::not_less:
        a_.jp(holds);
        a_.jb(failed_);
        break;
      case Check::finite:
        break;
    }
    a_.bind(holds);
  }

  void leave_unless_zero(const Place& place, const Label& after) override {
    if (place.kind == Place::Kind::reg) {
      a_.vucomisd(xmm(place), x86::qword_ptr(table_, zero));
      a_.jp(after);
      a_.jne(after);
      return;
    }
    a_.mov(x86::rax, memory(place));  // compared as bits, without the sign of a zero
    a_.add(x86::rax, x86::rax);
    a_.jnz(after);
  }

  static constexpr std::int32_t sign_mask = 0, magnitude_mask = 16, zero = 32, masks = 48;  // bytes
  void embed_table() override {
    constexpr std::uint64_t sign = 1ull << 63;
    embed({sign, sign, ~sign, ~sign, 0, 0});
    if (!constants_.empty()) a_.embed(constants_.data(), 8 * constants_.size());
  }

  const std::vector<double>& constants_;
  Label unchanged_;    // the end of the open branch
  Place chosen_by_{};  // the number that the open branch tests, if there is one
};

}  // namespace

unsigned scalar_registers() {
  const auto& features = CpuInfo::host().features().x86();
  if (!Environment::host().isFamilyX86() || !Environment::host().is64Bit() || !features.hasAVX()) return 0;
  return features.hasAVX512_F() && features.hasAVX512_VL() && features.hasAVX512_DQ() && features.hasFMA() ? 32 : 16;
}

bool needs_masks(const Program& program) {
  return !program.ends_at.empty() ||
         std::any_of(program.operations.begin(), program.operations.end(),
                     [](const Program::Operation& operation) { return operation.instruction == Instruction::choose; });
}

std::unique_ptr<const Function> assembled(const PlacedProgram& program, const std::vector<double>& constants) {
  return assembled_by<ScalarAssembler>(program, constants);
}

}  // namespace hamflow::native
