// A straight line of operations on doubles that is repeated: one step of a method, recorded (record/recording.hpp),
// with all that is carried from step to step. It is what is translated into machine code (src/native), and what an
// interpreter runs where that cannot be; both give the bits of the program that was recorded. Nothing may be reordered,
// fused or simplified that is not equal for every input, zeros' signs included; only NaN's payloads are free.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "hamflow/detail/core/operation.hpp"

namespace hamflow {

/// What operations are called in programs: arithmetic, the functions of formulas, and what is of programs alone.
using Instruction = Operation;

/// The value of an earlier operation, of what is carried, or of a constant.
struct Operand {
  enum class Kind : std::uint8_t { carried, result, constant, none };
  Kind kind = Kind::none;
  std::uint32_t index = 0;
  friend bool operator==(const Operand&, const Operand&) = default;
};

/// **Program**: values() are carried into a step; operations follow one another; the k-th output is carried out as the
/// k-th value. Checks hold, or the step is not of this program.
struct Program {
  struct Operation {
    Instruction instruction;
    Operand a;
    Operand b;    // none for functions of one number
    Operand c{};  // of choose
    friend bool operator==(const Operation&, const Operation&) = default;
  };
  struct Check {
    enum class Kind : std::uint8_t { finite, equal, unequal, less, not_less };  // a alone, or a with b
    Kind kind;
    Operand a;
    Operand b;
    friend bool operator==(const Check&, const Check&) = default;
  };
  std::vector<Operation> operations;
  std::vector<double> constants;
  std::vector<Operand> outputs;
  std::vector<Check> checks;
  std::vector<std::uint32_t> ends_at{};  // no step follows one that leaves any of these values other than 0

  /// How many numbers are carried.
  std::size_t values() const { return outputs.size(); }
};

/// A program made runnable. One object may be run by several threads at once.
class StepLoop {
 public:
  virtual ~StepLoop() = default;
  /// Repeats the program on `carried`, in place, `steps` times, or fewer where it ends by itself (Program::ends_at).
  /// @return how many; -1 where a check failed, `carried` is then undefined
  virtual std::int64_t take(std::span<double> carried, std::int64_t steps) const = 0;
  /// The same. @return whether every check held in every step
  bool run(std::span<double> carried, std::int64_t steps) const { return take(carried, steps) >= 0; }
};

/// In machine code where the processor and the system allow it and HAMFLOW_NATIVE is not 0, else interpreted.
std::unique_ptr<const StepLoop> make_step_loop(const Program& program);
/// Interpreted anywhere.
std::unique_ptr<const StepLoop> make_interpreter(const Program& program);

}  // namespace hamflow
