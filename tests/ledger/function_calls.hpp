// Which results depend on functions that are not correctly rounded: the linker leads them through counters
// (tests/CMakeLists.txt).
#pragma once

#include <cstdint>

namespace hamflow::test {

/// Whether exp, sin, ... were called since the last call of this function.
struct FunctionCalls {
  bool c_library = false;
  bool double_double = false;
};
FunctionCalls function_calls();

/// A hash of what the functions of the C library return for some arguments.
std::uint64_t hash_of_c_library();

}  // namespace hamflow::test
