// Gaussian elimination with partial pivoting for number types that Eigen does not support, that is, those with more
// digits than hardware types.   [GolubVanLoan2013, Sect. 3.4]
#pragma once

#include <cstddef>
#include <vector>

#include "hamflow/core/math.hpp"
#include "hamflow/detail/core/pool.hpp"

namespace hamflow::detail {

/// b <- m^-1 b, both stored row by row, b with the given number of columns. Returns det m. If m is singular, entries
/// are not finite.
template <class R>
R eliminate(const R* m, R* b, std::size_t size, std::size_t columns) {
  std::vector<R, PoolAllocator<R>> a(m, m + size * size);
  R determinant(1);
  for (std::size_t k = 0; k < size; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < size; ++i) {
      if (abs(a[pivot * size + k]) < abs(a[i * size + k])) pivot = i;
    }
    if (pivot != k) {
      for (std::size_t j = k; j < size; ++j) std::swap(a[k * size + j], a[pivot * size + j]);
      for (std::size_t j = 0; j < columns; ++j) std::swap(b[k * columns + j], b[pivot * columns + j]);
      determinant = -determinant;
    }
    determinant *= a[k * size + k];
    for (std::size_t i = k + 1; i < size; ++i) {
      const R factor = a[i * size + k] / a[k * size + k];
      for (std::size_t j = k + 1; j < size; ++j) a[i * size + j] -= factor * a[k * size + j];
      for (std::size_t j = 0; j < columns; ++j) b[i * columns + j] -= factor * b[k * columns + j];
    }
  }
  for (std::size_t k = size; k-- > 0;) {
    for (std::size_t c = 0; c < columns; ++c) {
      R x = b[k * columns + c];
      for (std::size_t j = k + 1; j < size; ++j) x -= a[k * size + j] * b[j * columns + c];
      b[k * columns + c] = x / a[k * size + k];
    }
  }
  return determinant;
}

}  // namespace hamflow::detail
