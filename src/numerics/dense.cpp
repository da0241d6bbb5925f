// Calls of Eigen, compiled once, because Eigen takes longer to compile than the rest of a problem.
#include "hamflow/detail/numerics/dense.hpp"

#include <Eigen/LU>
#include <cmath>
#include <utility>

namespace hamflow::detail {

namespace {
template <class R>
using RowMajor = Eigen::Matrix<R, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t few = 4;

/// Solves small systems like Eigen, with the same order and bits, in a tenth of the time: in a step of an implicit
/// method with one or two coordinates, calls of Eigen cost more than the forces.
template <class R>
void solve_small(const R* m, R* b, std::size_t size) {
  R a[few][few];
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) a[i][j] = m[i * size + j];
  }
  for (std::size_t k = 0; k < size; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < size; ++i) {
      if (std::abs(a[pivot][k]) < std::abs(a[i][k])) pivot = i;
    }
    if (a[pivot][k] != 0) {
      if (pivot != k) {
        for (std::size_t j = 0; j < size; ++j) std::swap(a[k][j], a[pivot][j]);
        std::swap(b[k], b[pivot]);
      }
      for (std::size_t i = k + 1; i < size; ++i) a[i][k] /= a[k][k];
    }
    for (std::size_t i = k + 1; i < size; ++i) {
      for (std::size_t j = k + 1; j < size; ++j) a[i][j] -= a[i][k] * a[k][j];
    }
  }
  for (std::size_t k = 1; k < size; ++k) {
    for (std::size_t i = 0; i < k; ++i) b[k] -= a[k][i] * b[i];
  }
  for (std::size_t k = size; k-- > 0;) {
    for (std::size_t j = k + 1; j < size; ++j) b[k] -= a[k][j] * b[j];
    b[k] *= R(1) / a[k][k];
  }
}

template <class R>
void solve_with(const R* m, R* b, std::size_t size, std::size_t columns) {
  if (size <= few && columns == 1) {
    solve_small(m, b, size);
    return;
  }
  // Kept between calls, so that a run, which solves systems of one size, does not allocate.
  static thread_local Eigen::PartialPivLU<RowMajor<R>> factors;
  static thread_local RowMajor<R> solution;
  const auto n = static_cast<Eigen::Index>(size);
  Eigen::Map<RowMajor<R>> right(b, n, static_cast<Eigen::Index>(columns));
  factors.compute(Eigen::Map<const RowMajor<R>>(m, n, n));
  solution.noalias() = factors.solve(right);
  right = solution;
}
template <class R>
R determinant_with(const R* m, std::size_t size) {
  const auto n = static_cast<Eigen::Index>(size);
  return Eigen::Map<const RowMajor<R>>(m, n, n).partialPivLu().determinant();
}

template <class R, std::size_t N>
using Fixed = Eigen::Matrix<R, static_cast<int>(N), static_cast<int>(N)>;
template <class R, std::size_t N>
Fixed<R, N> to_eigen(const Matrix<R, N>& m) {
  Fixed<R, N> e;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) e(static_cast<int>(i), static_cast<int>(j)) = m[i][j];
  }
  return e;
}
}  // namespace

template <class R, std::size_t N>
void solve_small(const Matrix<R, N>& m, Vector<R, N>& b) {
  Eigen::Matrix<R, static_cast<int>(N), 1> x;
  for (std::size_t i = 0; i < N; ++i) x(static_cast<int>(i)) = b[i];
  x = (to_eigen(m).inverse() * x).eval();
  for (std::size_t i = 0; i < N; ++i) b[i] = x(static_cast<int>(i));
}
template <class R, std::size_t N>
void invert_small(const Matrix<R, N>& m, Matrix<R, N>& out) {
  const Fixed<R, N> e = to_eigen(m).inverse();
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) out[i][j] = e(static_cast<int>(i), static_cast<int>(j));
  }
}
template <class R, std::size_t N>
R determinant_small(const Matrix<R, N>& m) {
  return to_eigen(m).determinant();
}

#define HAMFLOW_SMALL(R, N)                                           \
  template void solve_small(const Matrix<R, N>&, Vector<R, N>&);      \
  template void invert_small(const Matrix<R, N>&, Matrix<R, N>& out); \
  template R determinant_small(const Matrix<R, N>&);
#define HAMFLOW_SMALL_UP_TO_4(R) HAMFLOW_SMALL(R, 1) HAMFLOW_SMALL(R, 2) HAMFLOW_SMALL(R, 3) HAMFLOW_SMALL(R, 4)
HAMFLOW_SMALL_UP_TO_4(double)
HAMFLOW_SMALL_UP_TO_4(long double)
#undef HAMFLOW_SMALL_UP_TO_4
#undef HAMFLOW_SMALL

void solve_large(const double* m, double* b, std::size_t size, std::size_t columns) { solve_with(m, b, size, columns); }
void solve_large(const long double* m, long double* b, std::size_t size, std::size_t columns) {
  solve_with(m, b, size, columns);
}
double determinant_large(const double* m, std::size_t size) { return determinant_with(m, size); }
long double determinant_large(const long double* m, std::size_t size) { return determinant_with(m, size); }

}  // namespace hamflow::detail
