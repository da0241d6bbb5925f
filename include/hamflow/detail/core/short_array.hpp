// An array whose size is chosen at construction. A few numbers, as most systems have, are stored in place, so that a
// temporary of a step needs no allocation.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <type_traits>

#include "hamflow/detail/core/pool.hpp"

namespace hamflow {

/// An array with value semantics. Moving it may move its numbers.
template <class R>
class ShortArray {
  static_assert(std::is_trivially_copyable_v<R> && std::is_trivially_destructible_v<R>);

 public:
  ShortArray() : first_(here_) {}
  ShortArray(std::size_t size, const R& value) : ShortArray(Room{size}) {
    std::uninitialized_fill_n(first_, size, value);
  }
  ShortArray(std::initializer_list<R> values) : ShortArray(Room{values.size()}) {
    std::uninitialized_copy_n(values.begin(), values.size(), first_);
  }
  ShortArray(const ShortArray& other) : ShortArray(Room{other.size_}) {
    std::uninitialized_copy_n(other.first_, other.size_, first_);
  }
  ShortArray(ShortArray&& other) noexcept { take(other); }
  ShortArray& operator=(const ShortArray& other) {
    if (this == &other) return *this;  // self-assignment
    if (size_ == other.size_) {
      std::copy_n(other.first_, size_, first_);
    } else {
      *this = ShortArray(other);
    }
    return *this;
  }
  ShortArray& operator=(ShortArray&& other) noexcept {
    if (this != &other) {
      give_back();
      take(other);
    }
    return *this;
  }
  ~ShortArray() { give_back(); }

  std::size_t size() const { return size_; }
  R* data() { return first_; }
  const R* data() const { return first_; }
  R& operator[](std::size_t i) { return first_[i]; }
  const R& operator[](std::size_t i) const { return first_[i]; }
  friend bool operator==(const ShortArray& a, const ShortArray& b) {
    return a.size_ == b.size_ && std::equal(a.first_, a.first_ + a.size_, b.first_);
  }

 private:
  static constexpr std::size_t most_in_place = sizeof(R) < 128 ? 128 / sizeof(R) : 1;
  struct Room {
    std::size_t size;
  };

  explicit ShortArray(Room room)
      : first_(room.size <= most_in_place ? here_ : PoolAllocator<R>().allocate(room.size)), size_(room.size) {}
  void take(ShortArray& other) {
    size_ = other.size_;
    if (size_ <= most_in_place) {
      first_ = here_;
      std::uninitialized_copy_n(other.first_, size_, first_);
    } else {
      first_ = other.first_;
      other.first_ = other.here_;
    }
    other.size_ = 0;
  }
  void give_back() {
    if (size_ > most_in_place) PoolAllocator<R>().deallocate(first_, size_);
  }

  R* first_;
  std::size_t size_ = 0;
  union {
    R here_[most_in_place];
  };
};

}  // namespace hamflow
