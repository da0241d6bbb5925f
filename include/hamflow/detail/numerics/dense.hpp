// Dense linear systems: Cramer's rule for 2 x 2, which is forward stable there [Higham2002, Sect. 1.10.1] and dominates
// Newton in the plane; Eigen's closed-form inverses up to 4 x 4; LU with partial pivoting for larger systems.
#pragma once

#include "hamflow/core/math.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/numerics/elimination.hpp"

namespace hamflow {

namespace detail {
template <class R>
inline constexpr bool is_hardware = std::is_floating_point_v<R>;

/// b <- m^-1 b for a matrix of `size` rows and a right side of `columns` columns, both row by row. LU with partial
/// pivoting, compiled once (src/numerics/dense.cpp). A singular m shows as entries that are not finite.
void solve_large(const double* m, double* b, std::size_t size, std::size_t columns);
void solve_large(const long double* m, long double* b, std::size_t size, std::size_t columns);
template <class R>
requires(!is_hardware<R>) void solve_large(const R* m, R* b, std::size_t size, std::size_t columns) {
  (void)eliminate(m, b, size, columns);
}
double determinant_large(const double* m, std::size_t size);
long double determinant_large(const long double* m, std::size_t size);
template <class R>
requires(!is_hardware<R>) R determinant_large(const R* m, std::size_t size) {
  return eliminate(m, static_cast<R*>(nullptr), size, 0);
}

/// Functions for matrices up to 4 x 4 by Eigen's closed forms, compiled in the same file: b <- m^-1 b, out = m^-1, det
/// m.
template <class R, std::size_t N>
void solve_small(const Matrix<R, N>& m, Vector<R, N>& b);
template <class R, std::size_t N>
void invert_small(const Matrix<R, N>& m, Matrix<R, N>& out);
template <class R, std::size_t N>
R determinant_small(const Matrix<R, N>& m);

/// The entries row by row, as dynamic matrices store them.
template <class R>
const Matrix<R, dynamic>& flat(const Matrix<R, dynamic>& m) {
  return m;
}
template <class R, std::size_t N>
std::vector<R, PoolAllocator<R>> flat(const Matrix<R, N>& m) {
  std::vector<R, PoolAllocator<R>> all(m.size() * m.size());
  for (std::size_t i = 0; i < m.size(); ++i) {
    for (std::size_t j = 0; j < m.size(); ++j) all[i * m.size() + j] = m[i][j];
  }
  return all;
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
  } else if constexpr (N <= 4 && detail::is_hardware<R>) {
    Vector<R, N> x = b;
    detail::solve_small(m, x);
    return x;
  } else {
    Vector<R, N> x = b;
    detail::solve_large(detail::flat(m).data(), x.begin(), b.size(), 1);
    return x;
  }
}

/// m^-1.
template <class R, std::size_t N>
Matrix<R, N> inverse(const Matrix<R, N>& m) {
  Matrix<R, N> out = m;
  if constexpr (N <= 4 && detail::is_hardware<R>) {
    detail::invert_small(m, out);
  } else {
    const std::size_t size = m.size();
    std::vector<R, PoolAllocator<R>> columns(size * size);
    for (std::size_t i = 0; i < size; ++i) columns[i * size + i] = R(1);
    detail::solve_large(detail::flat(m).data(), columns.data(), size, size);
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) out[i][j] = columns[i * size + j];
    }
  }
  return out;
}

template <class R, std::size_t N>
R determinant(const Matrix<R, N>& m) {
  if constexpr (N <= 4 && detail::is_hardware<R>) {
    return detail::determinant_small(m);
  } else {
    return detail::determinant_large(detail::flat(m).data(), m.size());
  }
}

/// ||m|| ||m^-1|| with the largest row sums of absolute values; not finite if m is singular.
template <class R, std::size_t N>
R condition_number(const Matrix<R, N>& m) {
  const auto largest_row_sum = [](const Matrix<R, N>& x) {
    R largest(0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      R sum(0);
      for (std::size_t j = 0; j < x.size(); ++j) sum += abs(x[i][j]);
      largest = sum <= largest ? largest : sum;  // keeps NaN
    }
    return largest;
  };
  return largest_row_sum(m) * largest_row_sum(inverse(m));
}

/// m x.
template <class R, std::size_t N>
Vector<R, N> apply(const Matrix<R, N>& m, const Vector<R, N>& x) {
  Vector<R, N> y = zeros_like(x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < x.size(); ++j) y[i] += m[i][j] * x[j];
  }
  return y;
}

/// The largest absolute entry.
template <class R, std::size_t N>
R max_norm(const Vector<R, N>& x) {
  R largest(0);
  for (std::size_t i = 0; i < x.size(); ++i) largest = larger(largest, R(abs(x[i])));
  return largest;
}

}  // namespace hamflow
