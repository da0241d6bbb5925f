// What Eigen does, compiled once: it is more to read and to compile than all the rest of a problem.
#include "hamflow/numerics/dense.hpp"

#include <Eigen/LU>

namespace hamflow::detail {

namespace {
template <class R>
using RowMajor = Eigen::Matrix<R, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

template <class R>
void solve_with(const R* m, R* b, std::size_t size, std::size_t columns) {
  // Kept from call to call: a run solves systems of one size, and then nothing is allocated.
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
