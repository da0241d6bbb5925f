// Small dense linear systems: Cramer's rule for 2 x 2, which is forward stable there [Higham2002, Sect. 1.10.1] and the
// heart of Newton in the plane, else Eigen's closed-form inverses up to 4 x 4 and LU with partial pivoting above.
#pragma once

#include <Eigen/LU>

#include "hamflow/core/math.hpp"
#include "hamflow/core/vector.hpp"

namespace hamflow {

namespace detail {
template <class R, std::size_t N>
Eigen::Matrix<R, static_cast<int>(N), static_cast<int>(N)> to_eigen(const Matrix<R, N>& m) {
  Eigen::Matrix<R, static_cast<int>(N), static_cast<int>(N)> e;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) e(static_cast<int>(i), static_cast<int>(j)) = m[i][j];
  }
  return e;
}
}  // namespace detail

/// x with m x = b. A singular m shows as entries that are not finite.
template <class R, std::size_t N>
Vector<R, N> solve(const Matrix<R, N>& m, const Vector<R, N>& b) {
  if constexpr (N == 1) {
    return {b[0] / m[0][0]};
  } else if constexpr (N == 2) {
    const R inverse_determinant = R(1) / (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
    return {(b[0] * m[1][1] - b[1] * m[0][1]) * inverse_determinant,
            (b[1] * m[0][0] - b[0] * m[1][0]) * inverse_determinant};
  } else {
    Eigen::Matrix<R, static_cast<int>(N), 1> right;
    for (std::size_t i = 0; i < N; ++i) right(static_cast<int>(i)) = b[i];
    Eigen::Matrix<R, static_cast<int>(N), 1> x;
    if constexpr (N <= 4) {
      x = detail::to_eigen(m).inverse() * right;
    } else {
      x = detail::to_eigen(m).partialPivLu().solve(right);
    }
    Vector<R, N> out{};
    for (std::size_t i = 0; i < N; ++i) out[i] = x(static_cast<int>(i));
    return out;
  }
}

/// m^-1.
template <class R, std::size_t N>
Matrix<R, N> inverse(const Matrix<R, N>& m) {
  const auto e = detail::to_eigen(m).inverse().eval();
  Matrix<R, N> out{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) out[i][j] = e(static_cast<int>(i), static_cast<int>(j));
  }
  return out;
}

/// m x.
template <class R, std::size_t N>
Vector<R, N> apply(const Matrix<R, N>& m, const Vector<R, N>& x) {
  Vector<R, N> y{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) y[i] += m[i][j] * x[j];
  }
  return y;
}

/// The largest absolute entry.
template <class R, std::size_t N>
R max_norm(const Vector<R, N>& x) {
  R largest(0);
  for (std::size_t i = 0; i < N; ++i) largest = larger(largest, R(abs(x[i])));
  return largest;
}

}  // namespace hamflow
