#include "allocations.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<long long> count{0};
}

long long hamflow::test::allocations() { return count; }

#if defined(__SANITIZE_ADDRESS__)
bool hamflow::test::counts_allocations() { return false; }
#else
bool hamflow::test::counts_allocations() { return true; }

// In a unit of their own: the compiler must not see that the pairs are malloc and free.
void* operator new(std::size_t size) {
  ++count;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
#endif
