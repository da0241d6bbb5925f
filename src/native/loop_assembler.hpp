// The loop around the steps of a placed program on x86-64, for scalars and lanes.
//
// rbx: array of carried values; r12: number of steps left; r13: constants that differ between lanes; r14: failed lanes.
// The frame is aligned to 64 bytes.
#pragma once

#include <asmjit/x86.h>

#include "memory.hpp"

namespace hamflow::native {

class LoopAssembler {
 public:
  virtual ~LoopAssembler() = default;
  /// Assembles the whole function.
  void run();

 protected:
  /// @param frame number of bytes on the stack that lines use, from rsp on
  LoopAssembler(const PlacedProgram& program, std::size_t frame, asmjit::CodeHolder& code);

  virtual void move(const Line& line) = 0;
  virtual void operation(const Line& line) = 0;
  virtual void call(Instruction instruction) = 0;
  virtual void check(const Line& line) = 0;
  virtual void leave_lanes() {}  // called before the function returns
  virtual void before(const Line& /*next*/) {}
  /// Jumps to `after` if the number is not 0.
  virtual void leave_unless_zero(const Place& place, const asmjit::Label& after) = 0;
  virtual void embed_table() = 0;

  void embed(const std::vector<std::uint64_t>& words) { a_.embed(words.data(), 8 * words.size()); }

  asmjit::x86::Assembler a_;
  asmjit::Label table_;   // the table of constants, after the code
  asmjit::Label failed_;  // returns -1

 private:
  void enter();
  void exit();
  void emit(const Line& line);

  const PlacedProgram& program_;
  std::size_t frame_;
};

/// Assembles a function and copies it to executable memory.
/// @tparam Assembler constructed from (program, constants..., code)
template <class Assembler, class... Constants>
std::unique_ptr<const Function> assembled_by(const PlacedProgram& program, const Constants&... constants) {
  class Errors final : public asmjit::ErrorHandler {
   public:
    void handleError(asmjit::Error error, const char*, asmjit::BaseEmitter*) override { demand(error); }
  } errors;
  asmjit::CodeHolder code;
  demand(code.init(asmjit::Environment::host()));
  code.setErrorHandler(&errors);
  Assembler(program, constants..., code).run();
  return made_executable(code);
}

}  // namespace hamflow::native
