// LU factors with partial pivoting that are kept: for several right sides, one after the other, of any number type.
// [GolubVanLoan2013, Sect. 3.4]
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "hamflow/core/math.hpp"
#include "hamflow/core/pool.hpp"
#include "hamflow/core/vector.hpp"

namespace hamflow {

template <class R>
class LuFactors {
 public:
  /// Of any square matrix. A singular one shows as solutions that are not finite.
  void factor(const Matrix<R, dynamic>& m) {
    lu_ = m;
    const std::size_t size = m.size();
    pivots_.resize(size);
    for (std::size_t k = 0; k < size; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < size; ++i) {
        if (abs(lu_[pivot][k]) < abs(lu_[i][k])) pivot = i;
      }
      pivots_[k] = pivot;
      if (pivot != k) {
        for (std::size_t j = 0; j < size; ++j) std::swap(lu_[k][j], lu_[pivot][j]);
      }
      const R inverse = R(1) / lu_[k][k];
      for (std::size_t i = k + 1; i < size; ++i) {
        const R factor = lu_[i][k] * inverse;
        lu_[i][k] = factor;
        for (std::size_t j = k + 1; j < size; ++j) lu_[i][j] -= factor * lu_[k][j];
      }
    }
  }
  /// x with m x = b.
  Vector<R, dynamic> solve(const Vector<R, dynamic>& b) const {
    Vector<R, dynamic> x = b;
    const std::size_t size = x.size();
    for (std::size_t k = 0; k < size; ++k) {
      if (pivots_[k] != k) std::swap(x[k], x[pivots_[k]]);
    }
    for (std::size_t k = 0; k < size; ++k) {
      for (std::size_t i = 0; i < k; ++i) x[k] -= lu_[k][i] * x[i];
    }
    for (std::size_t k = size; k-- > 0;) {
      for (std::size_t j = k + 1; j < size; ++j) x[k] -= lu_[k][j] * x[j];
      x[k] = x[k] / lu_[k][k];
    }
    return x;
  }

 private:
  Matrix<R, dynamic> lu_{};
  std::vector<std::size_t, PoolAllocator<std::size_t>> pivots_;
};

}  // namespace hamflow
