// Programs in machine code of x86-64 with AVX.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "registers.hpp"

namespace hamflow::native {

/// Executable memory with one function in it.
class Function {
 public:
  /// Repeats the steps of a placed program on `carried`, in place. Returns how many are left where it ended by itself,
  /// 0 else; scalar code -1 once a check fails. In code for lanes bit i of failed[r] is set once a check fails in lane
  /// i of the r-th register of a value.
  using Entry = std::int64_t (*)(double* carried, std::int64_t steps, const double* varying, std::uint64_t* failed);
  virtual ~Function() = default;
  virtual Entry entry() const = 0;
  virtual std::size_t bytes() const = 0;  // of code and constants
};

/// Registers of this processor that a scalar program can use; 0 where there is no AVX.
unsigned scalar_registers();

/// Whether it chooses between numbers or ends by itself: lanes of AVX2 then have one register fewer, for the mask.
bool needs_masks(const Program& program);

/// Null where the system refuses executable memory. No memory is ever writable and executable by one address.
std::unique_ptr<const Function> assembled(const PlacedProgram& program, const std::vector<double>& constants);

/// The loop in machine code; null where processor or system do not allow it.
std::unique_ptr<const StepLoop> make_machine_code(const Program& program);

}  // namespace hamflow::native
