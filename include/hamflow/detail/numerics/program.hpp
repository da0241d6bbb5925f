// A straight-line program on doubles that is repeated: one recorded step of a method (record/recording.hpp), with all
// data that pass from step to step. It is translated into machine code (src/native) or run by an interpreter; both give
// the bits of the recorded operations. Reordering, fusing and simplifying are allowed only if the result is equal for
// every input, including the signs of zeros; only the payloads of NaN may differ.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "hamflow/detail/core/operation.hpp"

namespace hamflow {

/// The name of operations in programs: arithmetic, the functions of formulas, and operations of programs only.
using Instruction = Operation;

/// The value of an earlier operation, a carried value or a constant.
struct Operand {
  enum class Kind : std::uint8_t { carried, result, constant, none };
  Kind kind = Kind::none;
  std::uint32_t index = 0;
  friend bool operator==(const Operand&, const Operand&) = default;
};

/// **Program**: values() are carried into a step; operations follow one another; the k-th output is carried out as the
/// k-th value. If a check fails, the step is not one of this program.
struct Program {
  struct Operation {
    Instruction instruction;
    Operand a;
    Operand b;    // unused by functions of one number
    Operand c{};  // used by choose and fused operations
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
  std::vector<std::uint32_t> ends_at{};  // the loop ends after a step that sets any of these values to other than 0

  /// The number of carried values.
  std::size_t values() const { return outputs.size(); }
};

/// A runnable program. Several threads may run one object at once.
class StepLoop {
 public:
  virtual ~StepLoop() = default;
  /// Repeats the program on `carried`, in place, `steps` times, or fewer if it ends by itself (Program::ends_at).
  /// @return the number of steps; -1 if a check failed, `carried` is then undefined
  virtual std::int64_t take(std::span<double> carried, std::int64_t steps) const = 0;
  /// As take(). @return whether every check held in every step
  bool run(std::span<double> carried, std::int64_t steps) const { return take(carried, steps) >= 0; }
};

/// Uses machine code if the processor and the system allow it and HAMFLOW_NATIVE is not 0, else an interpreter.
std::unique_ptr<const StepLoop> make_step_loop(const Program& program);
/// Always interpreted.
std::unique_ptr<const StepLoop> make_interpreter(const Program& program);

}  // namespace hamflow
