#include "monodromy.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "hamflow/core/error.hpp"
#include "symplectic.hpp"

namespace hamflow {

namespace {

std::vector<State<double>> unit_vectors(std::size_t size) {
  std::vector<State<double>> all(size, State<double>(size));
  for (std::size_t k = 0; k < size; ++k) all[k][k] = 1;
  return all;
}

std::vector<std::vector<double>> transposed(const std::vector<State<double>>& columns) {
  std::vector<std::vector<double>> rows(columns.size(), std::vector<double>(columns.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < rows.size(); ++k) rows[i][k] = columns[k][i];
  }
  return rows;
}

}  // namespace

SymplecticEigenvalues symplectic_eigenvalues(const std::vector<std::vector<double>>& rows) {
  SymplecticEigenvalues found;
  const auto size = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd m(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    double sum = 0;
    for (Eigen::Index k = 0; k < size; ++k) {
      m(i, k) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
      sum += std::abs(m(i, k));
    }
    if (!(sum <= std::numeric_limits<double>::max())) throw Error("the derivative of the steps is not finite");
    found.norm = std::max(found.norm, sum);
  }
  for_each_symplectic_defect(
      rows, [&](double defect, double) { found.symplectic_defect = std::max(found.symplectic_defect, defect); });
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(m, false);
  if (solver.info() != Eigen::Success)
    throw Error("the eigenvalues of the derivative of the steps could not be computed");
  std::vector<std::complex<double>> left(solver.eigenvalues().data(), solver.eigenvalues().data() + size);
  while (!left.empty()) {  // takes the largest remaining eigenvalue and the one closest to its inverse
    const auto larger = std::max_element(left.begin(), left.end(), [](const auto& a, const auto& b) {
      return std::abs(a) != std::abs(b) ? std::abs(a) < std::abs(b) : a.imag() < b.imag();
    });
    const std::complex<double> value = *larger;
    left.erase(larger);
    const auto partner = std::min_element(left.begin(), left.end(), [&](const auto& a, const auto& b) {
      return std::abs(value * a - 1.0) < std::abs(value * b - 1.0);
    });
    found.values.push_back(value);
    found.values.push_back(*partner);
    found.pair_defect = std::max(found.pair_defect, std::abs(value * *partner - 1.0));
    left.erase(partner);
  }
  return found;
}

std::vector<std::vector<double>> derivative_of_steps(const StepMap& map, State<double> z, double h,
                                                     std::int64_t steps) {
  std::vector<State<double>> columns = unit_vectors(2 * map.dimension());
  if (!map.advance_with_tangents(z, columns, h, steps)) return {};
  return transposed(columns);
}

MonodromyObserver::MonodromyObserver(std::shared_ptr<const StepMap> map, double h, std::int64_t last_step)
    : TangentObserver(std::move(map), h, last_step), columns_(unit_vectors(2 * dimension())) {}

MonodromyObserver::MonodromyObserver(StepMapSource source, double h, std::int64_t last_step)
    : TangentObserver(std::move(source), h, last_step), columns_(unit_vectors(2 * dimension())) {}

std::vector<std::vector<double>> MonodromyObserver::rows() const { return transposed(columns_); }

}  // namespace hamflow
