// Executable memory, which all functions share.
#pragma once

#include <asmjit/core.h>

#include "machine_code.hpp"

namespace hamflow::native {

/// Throws std::logic_error on an error of asmjit. Such an error is a fault of hamflow, never of the input.
void demand(asmjit::Error error);

/// Copies code to executable memory. Returns null if the system refuses it.
std::unique_ptr<const Function> made_executable(asmjit::CodeHolder& code);

}  // namespace hamflow::native
