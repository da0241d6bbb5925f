// Programs as WebAssembly modules: a function that repeats a step. Each carried value and each result is a local
// variable, which the engine of the browser puts into registers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "hamflow/detail/numerics/program.hpp"

namespace hamflow::native {

/// What a local variable holds: one number, or two numbers of neighbouring lanes.
enum class Local { number, two_lanes };

/// A function in the table of functions, until the last copy of the pointer to it is gone.
class ModuleFunction {
 public:
  explicit ModuleFunction(int place) : place_(place) {}
  ~ModuleFunction();
  ModuleFunction(const ModuleFunction&) = delete;
  ModuleFunction& operator=(const ModuleFunction&) = delete;
  /// With Local::number: repeats the step on `carried`. Returns the number of steps left; -1 if a check failed.
  /// With Local::two_lanes: as Function::Entry (native/machine_code.hpp), with registers of four lanes.
  using Entry = std::int64_t (*)(double* carried, std::int64_t steps, const double* varying, std::uint64_t* failed);
  Entry entry() const { return reinterpret_cast<Entry>(static_cast<std::intptr_t>(place_)); }

 private:
  int place_;
};

/// Makes the function, or returns one that was made before from an equal program. Null if the program is too long,
/// needs an instruction that there is not, or the browser refuses it.
/// @param locals with Local::two_lanes the number of local variables of a value, by which the program is interleaved;
/// even
/// @param uniform constants from here on are read from the array `varying`
std::shared_ptr<const ModuleFunction> module_function(const Program& program, Local local, std::size_t locals,
                                                      std::size_t uniform);

}  // namespace hamflow::native
