// The lines of a placed program in instructions of x86-64 with AVX, one line after the other.
//
// rbx: the array of what is carried; r12: steps left; r13: constants that differ from lane to lane; r14: failed lanes.
// The frame is aligned to 64 bytes: arguments of a library call for lanes first, then the slots.
#include <asmjit/x86.h>

#include <stdexcept>

#include "functions.hpp"
#include "memory.hpp"

namespace hamflow::native {
namespace {

using namespace asmjit;  // NOLINT
namespace Inst = x86::Inst;

class ScalarAssembler {
 public:
  ScalarAssembler(const PlacedProgram& program, const std::vector<double>& constants, CodeHolder& code)
      : program_(program), constants_(constants), a_(&code) {
    table_ = a_.newLabel();
    failed_ = a_.newLabel();
  }

  void run() {
    const Label loop = a_.newLabel(), after = a_.newLabel(), leave = a_.newLabel();
    enter();
    for (const Line& line : program_.entry) one(line);
    a_.test(x86::r12, x86::r12);
    a_.jle(after);
    demand(a_.align(AlignMode::kCode, 32));
    a_.bind(loop);
    for (const Line& line : program_.body) one(line);
    a_.dec(x86::r12);
    a_.jnz(loop);
    a_.bind(after);
    for (const Line& line : program_.exit) one(line);
    a_.mov(x86::eax, 1);
    a_.bind(leave);
    exit();
    a_.bind(failed_);
    a_.xor_(x86::eax, x86::eax);
    a_.jmp(leave);
    embed_table();
  }

 private:
  static constexpr int saved = 4;  // registers below rbp
  void enter() {
    a_.push(x86::rbp);
    a_.mov(x86::rbp, x86::rsp);
    for (const x86::Gp& r : {x86::rbx, x86::r12, x86::r13, x86::r14}) a_.push(r);
    a_.sub(x86::rsp, Imm(8 * program_.slots));
    a_.and_(x86::rsp, -64);
    a_.mov(x86::rbx, x86::rdi);
    a_.mov(x86::r12, x86::rsi);
  }
  void exit() {
    a_.lea(x86::rsp, x86::ptr(x86::rbp, -8 * saved));
    for (const x86::Gp& r : {x86::r14, x86::r13, x86::r12, x86::rbx, x86::rbp}) a_.pop(r);
    a_.ret();
  }

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

  /// An operand that may be in a register or in memory.
  template <class Emit>
  void with(const Place& place, const Emit& emit) {
    if (place.kind == Place::Kind::reg) {
      emit(xmm(place));
    } else {
      emit(memory(place));
    }
  }

  void one(const Line& line) {
    switch (line.kind) {
      case Line::Kind::move:
        return move(line);
      case Line::Kind::operation:
        return operation(line);
      case Line::Kind::call:
        return call(line.instruction);
      case Line::Kind::check:
        return check(line);
    }
  }

  void move(const Line& line) {
    if (line.to.kind != Place::Kind::reg) {
      a_.vmovsd(memory(line.to), xmm(line.a));
    } else if (line.a.kind == Place::Kind::reg) {
      a_.vmovapd(xmm(line.to), xmm(line.a));
    } else {
      a_.vmovsd(xmm(line.to), memory(line.a));
    }
  }

  void operation(const Line& line) {
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
      case Instruction::larger:  // the second where they are equal or one is NaN
        return with(line.b, [&](const auto& b) { a_.vmaxsd(to, a, b); });
      case Instruction::negate:
        a_.vxorpd(to, a, x86::ptr(table_, sign_mask));
        return;
      case Instruction::absolute:
        a_.vandpd(to, a, x86::ptr(table_, magnitude_mask));
        return;
      case Instruction::square_root:
        a_.vsqrtsd(to, a, a);  // the other half from a as well: no wait for what `to` was
        return;
      default:
        throw std::logic_error("machine code: an instruction that is a call");
    }
  }

  void call(Instruction instruction) {
    const auto one = function_of_one(instruction);
    a_.mov(x86::rax, Imm(one ? reinterpret_cast<std::uintptr_t>(one)
                             : reinterpret_cast<std::uintptr_t>(function_of_two(instruction))));
    a_.call(x86::rax);
  }

  void check(const Line& line) {
    using Check = Program::Check::Kind;
    const x86::Xmm a = xmm(line.a);
    if (line.check == Check::finite) {  // x - x is NaN where x is not finite
      a_.vsubsd(xmm(line.to), a, a);
      a_.vucomisd(xmm(line.to), xmm(line.to));
      a_.jp(failed_);
      return;
    }
    with(line.b, [&](const auto& b) { a_.vucomisd(a, b); });
    const Label holds = a_.newLabel();
    switch (line.check) {  // unordered sets the parity, zero and carry flags
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

  static constexpr std::int32_t sign_mask = 0, magnitude_mask = 16, masks = 32;  // bytes
  void embed_table() {
    a_.align(AlignMode::kData, 64);
    a_.bind(table_);
    constexpr std::uint64_t sign = 1ull << 63;
    const std::uint64_t both[4] = {sign, sign, ~sign, ~sign};
    a_.embed(both, sizeof both);
    if (!constants_.empty()) a_.embed(constants_.data(), 8 * constants_.size());
  }

  const PlacedProgram& program_;
  const std::vector<double>& constants_;
  x86::Assembler a_;
  Label table_, failed_;
};

class Errors final : public ErrorHandler {
 public:
  void handleError(Error error, const char*, BaseEmitter*) override { demand(error); }
};

}  // namespace

unsigned scalar_registers() {
  const auto& features = CpuInfo::host().features().x86();
  if (!Environment::host().isFamilyX86() || !Environment::host().is64Bit() || !features.hasAVX()) return 0;
  return features.hasAVX512_F() && features.hasAVX512_VL() && features.hasAVX512_DQ() ? 32 : 16;
}

std::unique_ptr<const Function> assembled(const PlacedProgram& program, const std::vector<double>& constants) {
  Errors errors;
  CodeHolder code;
  demand(code.init(Environment::host()));
  code.setErrorHandler(&errors);
  ScalarAssembler(program, constants, code).run();
  return made_executable(code);
}

}  // namespace hamflow::native
