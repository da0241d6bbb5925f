// A vector of N numbers: the coordinates q or the momenta p of one system, or a force, or a row of a matrix.
#pragma once

#include <cstddef>

namespace hamflow {

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
  friend constexpr bool operator==(const Vector&, const Vector&) = default;
};

/// N x N numbers, m[row][column].
template <class R, std::size_t N>
using Matrix = Vector<Vector<R, N>, N>;

/// The same values in another number type.
template <class To, class From, std::size_t N>
constexpr Vector<To, N> cast(const Vector<From, N>& x) {
  Vector<To, N> y{};
  for (std::size_t i = 0; i < N; ++i) y[i] = static_cast<To>(x[i]);
  return y;
}

}  // namespace hamflow
