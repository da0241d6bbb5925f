// Eigen's solver, compiled once, because it takes longer to compile than a whole problem.
#include "hamflow/detail/numerics/normal_modes.hpp"

#include <Eigen/Eigenvalues>

namespace hamflow {

bool normal_modes(const long double* m, const long double* c, std::size_t n, long double* eigenvalues,
                  long double* vectors) {
  using Dense = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto size = static_cast<Eigen::Index>(n);
  const Dense mass = Eigen::Map<const Dense>(m, size, size);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Dense> solver(Eigen::Map<const Dense>(c, size, size), mass,
                                                               Eigen::ComputeEigenvectors | Eigen::Ax_lBx);
  Eigen::Map<Eigen::Matrix<long double, Eigen::Dynamic, 1>>(eigenvalues, size) = solver.eigenvalues();
  Eigen::Map<Dense>(vectors, size, size) = solver.eigenvectors();
  return mass.llt().info() == Eigen::Success && solver.info() == Eigen::Success && solver.eigenvectors().allFinite();
}

}  // namespace hamflow
