// Counts the allocations of an executable that links allocations.cpp.
#pragma once

namespace hamflow::test {
long long allocations();
/// False under the address sanitizer, which brings an operator new of its own.
bool counts_allocations();
}  // namespace hamflow::test
