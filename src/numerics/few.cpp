#include "hamflow/detail/numerics/few.hpp"

namespace hamflow {

namespace {
template <std::size_t n>
SmallVector solved(const SmallRows& m, const SmallVector& b) {
  Matrix<double, n> matrix{};
  Vector<double, n> right{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) matrix[i][j] = m[i][j];
    right[i] = b[i];
  }
  const Vector<double, n> solution = hamflow::solve(matrix, right);
  SmallVector x = b;
  for (std::size_t i = 0; i < n; ++i) x[i] = solution[i];
  return x;
}
Matrix<double, dynamic> as_matrix(const SmallRows& m) {
  Matrix<double, dynamic> out(m.size());
  for (std::size_t i = 0; i < m.size(); ++i) {
    for (std::size_t j = 0; j < m.size(); ++j) out[i][j] = m[i][j];
  }
  return out;
}
}  // namespace

SmallVector solve(const SmallRows& m, const SmallVector& b) {
  switch (b.size()) {
    case 1:
      return solved<1>(m, b);
    case 2:
      return solved<2>(m, b);
    case 3:
      return solved<3>(m, b);
    case 4:
      return solved<4>(m, b);
    case 5:
      return solved<5>(m, b);
    default:
      return solved<6>(m, b);
  }
}

double determinant(const SmallRows& m) { return determinant(as_matrix(m)); }
double condition_number(const SmallRows& m) { return condition_number(as_matrix(m)); }

}  // namespace hamflow
