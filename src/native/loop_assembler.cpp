#include "loop_assembler.hpp"

namespace hamflow::native {

using namespace asmjit;  // NOLINT

LoopAssembler::LoopAssembler(const PlacedProgram& program, std::size_t frame, CodeHolder& code)
    : a_(&code), table_(a_.newLabel()), failed_(a_.newLabel()), program_(program), frame_(frame) {}

void LoopAssembler::run() {
  const Label loop = a_.newLabel(), after = a_.newLabel(), leave = a_.newLabel();
  enter();
  for (const Line& line : program_.entry) emit(line);
  a_.test(x86::r12, x86::r12);
  a_.jle(after);
  a_.align(AlignMode::kCode, 32);
  a_.bind(loop);
  for (const Line& line : program_.body) emit(line);
  before({});
  a_.dec(x86::r12);
  for (const Place& place : program_.ends_at) leave_unless_zero(place, after);
  if (!program_.ends_at.empty()) a_.test(x86::r12, x86::r12);
  a_.jnz(loop);
  a_.bind(after);
  for (const Line& line : program_.exit) emit(line);
  a_.mov(x86::rax, x86::r12);
  a_.bind(leave);
  exit();
  a_.bind(failed_);
  a_.mov(x86::rax, -1);
  a_.jmp(leave);
  a_.align(AlignMode::kData, 64);
  a_.bind(table_);
  embed_table();
}

void LoopAssembler::enter() {
  a_.push(x86::rbp);
  a_.mov(x86::rbp, x86::rsp);
  for (const x86::Gp& r : {x86::rbx, x86::r12, x86::r13, x86::r14}) a_.push(r);
  a_.sub(x86::rsp, Imm(frame_));
  a_.and_(x86::rsp, -64);
  a_.mov(x86::rbx, x86::rdi);
  a_.mov(x86::r12, x86::rsi);
  a_.mov(x86::r13, x86::rdx);
  a_.mov(x86::r14, x86::rcx);
}

void LoopAssembler::exit() {
  leave_lanes();
  a_.lea(x86::rsp, x86::ptr(x86::rbp, -32));  // the four registers pushed after rbp
  for (const x86::Gp& r : {x86::r14, x86::r13, x86::r12, x86::rbx, x86::rbp}) a_.pop(r);
  a_.ret();
}

void LoopAssembler::emit(const Line& line) {
  before(line);
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

}  // namespace hamflow::native
