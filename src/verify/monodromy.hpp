// Derivative of many steps, M = Psi_h'(z_(N-1)) .. Psi_h'(z_0). On a periodic orbit it is the monodromy matrix.
// Eigenvalues of a symplectic matrix come in pairs lambda, 1/lambda.   [HLW2006, Sect. VI.2; Arnold1989, Sect. 42]
#pragma once

#include <complex>

#include "hamflow/detail/verify/lyapunov.hpp"

namespace hamflow {

struct SymplecticEigenvalues {
  std::vector<std::complex<double>> values;  // in pairs, the larger one first; pairs in descending order
  double pair_defect = 0;                    // max |lambda lambda' - 1|
  double symplectic_defect = 0;              // largest entry of |M^T J M - J|
  /// Largest row sum of |M|. Rounding alone makes both defects about epsilon norm^2, because an eigenvalue of size
  /// 1/norm is only known to epsilon norm.
  double norm = 0;
};

/// @param rows rows of a 2n x 2n matrix   @throws Error if an entry is not finite
SymplecticEigenvalues symplectic_eigenvalues(const std::vector<std::vector<double>>& rows);
/// Returns the rows of d Psi_h^steps(z)/dz; empty if a step fails.
std::vector<std::vector<double>> derivative_of_steps(const StepMap& map, State<double> z, double h, std::int64_t steps);

/// Carries the derivative of all steps along a run. It costs as much as 2n Lyapunov exponents.
class MonodromyObserver final : public TangentObserver {
 public:
  MonodromyObserver(std::shared_ptr<const StepMap> map, double h, std::int64_t last_step);
  MonodromyObserver(StepMapSource source, double h, std::int64_t last_step);
  std::vector<std::vector<double>> rows() const;

 protected:
  std::vector<State<double>>& tangents() override { return columns_; }
  std::int64_t taken(std::int64_t) override { return 64; }
  void archive_tangents(Writer& ar) override { ar(columns_); }
  void archive_tangents(Reader& ar) override { ar(columns_); }

 private:
  std::vector<State<double>> columns_;
};

}  // namespace hamflow
