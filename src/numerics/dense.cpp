// Large systems, compiled once: Eigen's blocked LU is more to compile than all the rest of a problem.
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
}  // namespace

void solve_large(const double* m, double* b, std::size_t size, std::size_t columns) { solve_with(m, b, size, columns); }
void solve_large(const long double* m, long double* b, std::size_t size, std::size_t columns) {
  solve_with(m, b, size, columns);
}
double determinant_large(const double* m, std::size_t size) { return determinant_with(m, size); }
long double determinant_large(const long double* m, std::size_t size) { return determinant_with(m, size); }

}  // namespace hamflow::detail
