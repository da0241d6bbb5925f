// The exact solution of M q'' + C q = 0 as a sum of its modes, for symmetric positive M and symmetric C of any size.
// [Gross1999, (3.20)-(3.34)]   With C l = lambda M l and l_i^T M l_j = delta_ij, the modal coordinates y = L^T M q and
// their rates y' = L^T p, p = M q', are independent: y'' = -lambda y. An eigenvalue may be negative (the rest is
// unstable) or zero (a free motion).
#pragma once

#include <optional>

#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/numerics/dense.hpp"
#include "hamflow/detail/numerics/normal_modes.hpp"
#include "hamflow/detail/problems/linear_oscillator.hpp"

namespace hamflow {

template <std::size_t N>
class ModalSolution {
 public:
  using Coordinates = Vector<long double, N>;

  ModalSolution(const Matrix<long double, N>& mass, const Matrix<long double, N>& stiffness) : mass_(mass) {
    const std::vector<long double> m = rows_of(mass);
    solved_ = normal_modes(m.data(), rows_of(stiffness).data(), N, eigenvalues_.begin(), vectors_.data());
  }

  /// False if M is not positive definite or an entry is not finite.
  bool solved() const { return solved_; }

  /// lambda = omega^2, ascending.
  const Coordinates& eigenvalues() const { return eigenvalues_; }
  /// The k-th eigenform, of unit generalised mass.
  Coordinates form(std::size_t k) const {
    Coordinates out{};
    for (std::size_t i = 0; i < N; ++i) out[i] = vectors_[i * N + k];
    return out;
  }
  /// y = L^T M q.
  Coordinates modal_position(const Coordinates& q) const { return modal_velocity(apply(mass_, q)); }
  /// y' = L^T p.
  Coordinates modal_velocity(const Coordinates& p) const {
    Coordinates out{};
    for (std::size_t k = 0; k < N; ++k) {
      for (std::size_t i = 0; i < N; ++i) out[k] += vectors_[i * N + k] * p[i];
    }
    return out;
  }

  /// The state at time t. (3.33), (3.34)
  Start<long double, N> at(const Coordinates& q, const Coordinates& p, long double t) const {
    const Coordinates y = modal_position(q);
    const Coordinates rate = modal_velocity(p);
    Coordinates position{};
    Coordinates velocity{};
    for (std::size_t k = 0; k < N; ++k) {
      const LinearMotion mode = linear_motion(y[k], rate[k], eigenvalues_[k], t);
      position[k] = mode.position;
      velocity[k] = mode.velocity;
    }
    return {sum_of_forms(position), apply(mass_, sum_of_forms(velocity))};
  }

 private:
  static std::vector<long double> rows_of(const Matrix<long double, N>& m) {
    std::vector<long double> all;
    for (const auto& row : m) all.insert(all.end(), row.begin(), row.end());
    return all;
  }
  /// L y.
  Coordinates sum_of_forms(const Coordinates& y) const {
    Coordinates out{};
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t k = 0; k < N; ++k) out[i] += vectors_[i * N + k] * y[k];
    }
    return out;
  }

  Matrix<long double, N> mass_;
  Coordinates eigenvalues_{};
  std::vector<long double> vectors_ = std::vector<long double>(N * N);  // the k-th eigenform is the k-th column
  bool solved_ = false;
};

}  // namespace hamflow
