// A vector of N numbers: coordinates q, momenta p, a force, or a row of a matrix. If N is a number, the vector is
// stored in place; if N is `dynamic`, its length is chosen at run time.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <type_traits>
#include <utility>
#include <vector>

#include "hamflow/detail/core/pool.hpp"
#include "hamflow/detail/core/short_array.hpp"

namespace hamflow {

/// The number of degrees of freedom of systems whose size is chosen at run time.
inline constexpr std::size_t dynamic = static_cast<std::size_t>(-1);

/// N numbers of type R, stored in place. Brace-initialised: Vector<double, 2>{1.0, 2.0}.
template <class R, std::size_t N>
struct Vector {
  static_assert(N > 0, "hamflow: a system needs at least one degree of freedom");
  using value_type = R;

  R entry[N];

  constexpr R& operator[](std::size_t i) { return entry[i]; }
  constexpr const R& operator[](std::size_t i) const { return entry[i]; }
  static constexpr std::size_t size() { return N; }
  constexpr R* begin() { return entry; }
  constexpr R* end() { return entry + N; }
  constexpr const R* begin() const { return entry; }
  constexpr const R* end() const { return entry + N; }
  friend bool operator==(const Vector&, const Vector&) = default;
};

namespace detail {
/// The storage of a dynamic vector. Numbers with a destructor (any number of digits) are not moved.
template <class R>
using Numbers = std::conditional_t<std::is_trivially_copyable_v<R> && std::is_trivially_destructible_v<R>,
                                   ShortArray<R>, std::vector<R, PoolAllocator<R>>>;
}  // namespace detail

/// A vector whose length is chosen at run time, with value semantics. A few numbers are stored in place; the memory for
/// more comes from a pool, so that temporaries call the allocator in the first steps only.
template <class R>
struct Vector<R, dynamic> {
  using value_type = R;

  Vector() = default;
  explicit Vector(std::size_t size) : entry(size, R{}) {}
  Vector(std::initializer_list<R> values) : entry(values) {}

  R& operator[](std::size_t i) { return entry[i]; }
  const R& operator[](std::size_t i) const { return entry[i]; }
  std::size_t size() const { return entry.size(); }
  R* begin() { return entry.data(); }
  R* end() { return entry.data() + entry.size(); }
  const R* begin() const { return entry.data(); }
  const R* end() const { return entry.data() + entry.size(); }
  friend bool operator==(const Vector&, const Vector&) = default;

 private:
  detail::Numbers<R> entry;
};

/// A square matrix of any size, stored row by row in one block; m[row] points to the first entry of a row.
template <class R>
struct Vector<Vector<R, dynamic>, dynamic> {
  using value_type = R;

  Vector() = default;
  explicit Vector(std::size_t size) : size_(size), entry(size * size, R{}) {}

  R* operator[](std::size_t row) { return entry.data() + row * size_; }
  const R* operator[](std::size_t row) const { return entry.data() + row * size_; }
  const R* data() const { return entry.data(); }
  std::size_t size() const { return size_; }
  friend bool operator==(const Vector&, const Vector&) = default;

 private:
  std::size_t size_ = 0;
  detail::Numbers<R> entry;
};

/// N x N numbers, m[row][column].
template <class R, std::size_t N>
using Matrix = Vector<Vector<R, N>, N>;

/// A vector of zeros; `size` is used for `dynamic` vectors only.
template <class R, std::size_t N>
constexpr Vector<R, N> zeros([[maybe_unused]] std::size_t size) {
  if constexpr (N == dynamic) {
    return Vector<R, N>(size);
  } else {
    return Vector<R, N>{};
  }
}
/// A vector of zeros with the length of x.
template <class R, std::size_t N>
constexpr Vector<R, N> zeros_like(const Vector<R, N>& x) {
  return zeros<R, N>(x.size());
}
/// A matrix of zeros with as many rows as x has entries.
template <class R, std::size_t N>
constexpr Matrix<R, N> zero_matrix(const Vector<R, N>& x) {
  if constexpr (N == dynamic) {
    return Matrix<R, N>(x.size());
  } else {
    return Matrix<R, N>{};
  }
}

/// Returns the same values in another number type.
template <class To, class From, std::size_t N>
constexpr Vector<To, N> cast(const Vector<From, N>& x) {
  Vector<To, N> y = zeros<To, N>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) y[i] = static_cast<To>(x[i]);
  return y;
}

}  // namespace hamflow
