// Programs as machine code for x86-64 with AVX.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "registers.hpp"

namespace hamflow::native {

/// Executable memory that contains one function.
class Function {
 public:
  /// Repeats the steps of a placed program on `carried`, in place. Returns 0, or the number of steps left if the
  /// program stopped early. Scalar code returns -1 if a check fails. Code for lanes sets bit i of failed[r] if a check
  /// fails in lane i of the r-th register of a value.
  using Entry = std::int64_t (*)(double* carried, std::int64_t steps, const double* varying, std::uint64_t* failed);
  virtual ~Function() = default;
  virtual Entry entry() const = 0;
  virtual std::size_t bytes() const = 0;  // size of code and constants
};

/// The number of registers that a scalar program can use; 0 if the processor has no AVX.
unsigned scalar_registers();

/// Whether a program chooses between numbers or can stop early. AVX2 code for lanes then needs one register for the
/// mask.
bool needs_masks(const Program& program);

/// Assembles a function. Returns null if the system refuses executable memory. No address is both writable and
/// executable.
std::unique_ptr<const Function> assembled(const PlacedProgram& program, const std::vector<double>& constants);

/// Returns the loop as machine code; null if the processor or the system does not allow it.
std::unique_ptr<const StepLoop> make_machine_code(const Program& program);

}  // namespace hamflow::native
