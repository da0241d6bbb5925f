// LU factors for several right sides, one after the other, in any number type. [GolubVanLoan2013, Sect. 3.4]
//
// Pivoting is by threshold [DuffErismanReid2017, Chap. 5]: rows are exchanged only if an entry below the diagonal is
// more than 16 times as large. The Jacobians are near the identity, but the units of positions and momenta may scale
// rows by any factor. With full pivoting the order of rows would then change from step to step, and a recorded step
// (src/engine/recorded_iteration.hpp) is valid for only one order.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "hamflow/core/math.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/detail/core/pool.hpp"

namespace hamflow {

template <class R>
class LuFactors {
 public:
  /// Factors any square matrix. If it is singular, solutions are not finite.
  void factor(const Matrix<R, dynamic>& m) {
    lu_ = m;
    const std::size_t size = m.size();
    pivots_.resize(size);
    for (std::size_t k = 0; k < size; ++k) {
      std::size_t pivot = k;
      R least = R(threshold) * abs(lu_[k][k]);
      for (std::size_t i = k + 1; i < size; ++i) {
        const R here = abs(lu_[i][k]);
        if (!(least < here)) continue;
        pivot = i;
        least = here;
      }
      pivots_[k] = pivot;
      if (pivot != k) {
        for (std::size_t j = 0; j < size; ++j) std::swap(lu_[k][j], lu_[pivot][j]);
      }
      const R* const upper = lu_[k];
      const R inverse = R(1) / upper[k];
      for (std::size_t i = k + 1; i < size; ++i) {
        R* const row = lu_[i];
        const R factor = row[k] * inverse;
        row[k] = factor;
        for (std::size_t j = k + 1; j < size; ++j) row[j] -= factor * upper[j];
      }
    }
  }
  /// x with m x = b.
  Vector<R, dynamic> solve(const Vector<R, dynamic>& b) const {
    Vector<R, dynamic> solution = b;
    R* const x = solution.begin();
    const std::size_t size = solution.size();
    for (std::size_t k = 0; k < size; ++k) {
      if (pivots_[k] != k) std::swap(x[k], x[pivots_[k]]);
    }
    for (std::size_t k = 1; k < size; ++k) {
      const R* const row = lu_[k];
      R sum = x[k];
      for (std::size_t i = 0; i < k; ++i) sum -= row[i] * x[i];
      x[k] = sum;
    }
    for (std::size_t k = size; k-- > 0;) {
      const R* const row = lu_[k];
      R sum = x[k];
      for (std::size_t j = k + 1; j < size; ++j) sum -= row[j] * x[j];
      x[k] = sum / row[k];
    }
    return solution;
  }

 private:
  static constexpr int threshold = 16;
  Matrix<R, dynamic> lu_{};
  std::vector<std::size_t, PoolAllocator<std::size_t>> pivots_;
};

}  // namespace hamflow
