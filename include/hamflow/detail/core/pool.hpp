// A memory pool for short-lived vectors. Returned blocks are kept, by size, for the next request of that size. Each
// thread has its own pool, so that there are no locks.
#pragma once

#include <bit>
#include <cstddef>
#include <new>

namespace hamflow {

/// Blocks of 2^k bytes, k = 4 .. 47, or .. 31 where addresses have 32 bits. A block may be returned on another thread
/// than the one that requested it.
class Pool {
 public:
  static constexpr std::size_t most_bytes = std::size_t{1} << (sizeof(std::size_t) > 4 ? 47 : 31);

  static void* take(std::size_t bytes) {
    const std::size_t k = exponent(bytes);
    Block* const block = free_[k];
    if (block == nullptr) return ::operator new (std::size_t{1} << k);
    free_[k] = block->next;
    return block;
  }
  static void give(void* memory, std::size_t bytes) {
    if (phase_ != Phase::alive && !begins()) {  // the thread is ending and its pool is gone
      ::operator delete(memory);
      return;
    }
    const std::size_t k = exponent(bytes);
    free_[k] = new (memory) Block{free_[k]};
  }

 private:
  struct Block {
    Block* next;
  };
  /// Frees the blocks when the thread ends. It is separate from the blocks, so that access to them does not check
  /// whether a thread-local object with a destructor has been constructed.
  struct End {
    ~End() {
      phase_ = Phase::gone;
      for (Block*& first : free_) {
        while (first != nullptr) {
          Block* const next = first->next;
          ::operator delete(first);
          first = next;
        }
      }
    }
  };
  static constexpr std::size_t sizes = 48;
  enum class Phase : char { not_begun, alive, gone };

  [[gnu::cold, gnu::noinline]] static bool begins() {
    if (phase_ == Phase::gone) return false;
    static thread_local const End end;
    phase_ = Phase::alive;
    return true;
  }
  static std::size_t exponent(std::size_t bytes) {
    return static_cast<std::size_t>(std::bit_width((bytes < 16 ? 16 : bytes) - 1));
  }

  static inline constinit thread_local Phase phase_ = Phase::not_begun;
  static inline constinit thread_local Block* free_[sizes]{};
};

/// The pool as an allocator of the standard library.
template <class T>
struct PoolAllocator {
  static_assert(alignof(T) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__);
  using value_type = T;

  PoolAllocator() = default;
  template <class U>
  PoolAllocator(const PoolAllocator<U>&) {}  // NOLINT: allocators for different types convert

  T* allocate(std::size_t count) {
    if (count > Pool::most_bytes / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(Pool::take(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t count) { Pool::give(memory, count * sizeof(T)); }
  friend bool operator==(const PoolAllocator&, const PoolAllocator&) { return true; }
};

}  // namespace hamflow
