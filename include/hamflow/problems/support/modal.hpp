// The exact solution of M q'' + C q = 0 as a sum of its modes, for symmetric positive M and symmetric C of any size.
// [Gross1999, (3.20)-(3.34)]   With C l = lambda M l and l_i^T M l_j = delta_ij, the modal coordinates y = L^T M q and
// their rates y' = L^T p, p = M q', are independent: y'' = -lambda y. An eigenvalue may be negative (the rest is
// unstable) or zero (a free motion).
#pragma once

#include <Eigen/Dense>
#include <optional>

#include "hamflow/core/problem_info.hpp"
#include "hamflow/problems/support/linear_oscillator.hpp"

namespace hamflow {

template <std::size_t N>
class ModalSolution {
 public:
  using Coordinates = Vector<long double, N>;

  ModalSolution(const Matrix<long double, N>& mass, const Matrix<long double, N>& stiffness)
      : mass_(to_dense(mass)), solver_(to_dense(stiffness), mass_, Eigen::ComputeEigenvectors | Eigen::Ax_lBx) {}

  /// False when M is not positive or an entry is not finite.
  bool solved() const {
    return mass_.llt().info() == Eigen::Success && solver_.info() == Eigen::Success &&
           solver_.eigenvectors().allFinite();
  }

  /// lambda = omega^2, ascending.
  Coordinates eigenvalues() const { return to_coordinates(solver_.eigenvalues()); }
  /// The k-th eigenform, of unit generalised mass.
  Coordinates form(std::size_t k) const { return to_coordinates(solver_.eigenvectors().col(static_cast<int>(k))); }
  /// y = L^T M q.
  Coordinates modal_position(const Coordinates& q) const {
    return to_coordinates(solver_.eigenvectors().transpose() * (mass_ * to_dense(q)));
  }
  /// y' = L^T p.
  Coordinates modal_velocity(const Coordinates& p) const {
    return to_coordinates(solver_.eigenvectors().transpose() * to_dense(p));
  }

  /// The state at time t. (3.33), (3.34)
  Start<long double, N> at(const Coordinates& q, const Coordinates& p, long double t) const {
    const Coordinates y = modal_position(q);
    const Coordinates rate = modal_velocity(p);
    Column position;
    Column velocity;
    for (std::size_t k = 0; k < N; ++k) {
      const auto row = static_cast<int>(k);
      const LinearMotion mode = linear_motion(y[k], rate[k], solver_.eigenvalues()[row], t);
      position[row] = mode.position;
      velocity[row] = mode.velocity;
    }
    return {to_coordinates(solver_.eigenvectors() * position),
            to_coordinates(mass_ * (solver_.eigenvectors() * velocity))};
  }

 private:
  static constexpr int size = static_cast<int>(N);
  using Dense = Eigen::Matrix<long double, size, size>;
  using Column = Eigen::Matrix<long double, size, 1>;

  static Dense to_dense(const Matrix<long double, N>& m) {
    Dense out;
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) out(static_cast<int>(i), static_cast<int>(j)) = m[i][j];
    }
    return out;
  }
  static Column to_dense(const Coordinates& x) {
    Column out;
    for (std::size_t i = 0; i < N; ++i) out[static_cast<int>(i)] = x[i];
    return out;
  }
  static Coordinates to_coordinates(const Column& x) {
    Coordinates out{};
    for (std::size_t i = 0; i < N; ++i) out[i] = x[static_cast<int>(i)];
    return out;
  }

  Dense mass_;
  Eigen::GeneralizedSelfAdjointEigenSolver<Dense> solver_;
};

}  // namespace hamflow
