// Which results depend on the C library: the linker leads its functions through counters (tests/CMakeLists.txt).
#pragma once

#include <cstdint>

namespace hamflow::test {

/// Whether exp, sin, ... of the C library were called since the last call of this function.
bool called_c_library();

/// A hash of what these functions return for some arguments.
std::uint64_t hash_of_c_library();

}  // namespace hamflow::test
