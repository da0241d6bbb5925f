// Numbers for lanes, aligned for the widest register.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace hamflow {

namespace detail {
/// Memory at multiples of 64 bytes.
template <class T>
struct RegisterAllocator {
  using value_type = T;
  static constexpr std::align_val_t alignment{64};
  RegisterAllocator() = default;
  template <class U>
  RegisterAllocator(const RegisterAllocator<U>&) {}  // NOLINT: one allocator for every type
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), alignment)); }
  void deallocate(T* at, std::size_t) { ::operator delete(at, alignment); }
  friend bool operator==(const RegisterAllocator&, const RegisterAllocator&) { return true; }
};
}  // namespace detail

using LaneNumbers = std::vector<double, detail::RegisterAllocator<double>>;

}  // namespace hamflow
