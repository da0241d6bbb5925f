// Executable memory that all functions share.
#pragma once

#include <asmjit/core.h>

#include "machine_code.hpp"

namespace hamflow::native {

/// Throws std::logic_error on any error: what is assembled here is never at fault by its input.
void demand(asmjit::Error error);

/// The code where it can be run; null where the system refuses that.
std::unique_ptr<const Function> made_executable(asmjit::CodeHolder& code);

}  // namespace hamflow::native
