// The derivative of many steps, M = Psi_h'(z_(N-1)) .. Psi_h'(z_0): on a periodic orbit the monodromy matrix.
// Eigenvalues of a symplectic matrix come in pairs lambda, 1/lambda.   [HLW2006, Sect. VI.2; Arnold1989,
// Sect. 42]
#pragma once

#include <complex>

#include "hamflow/detail/verify/lyapunov.hpp"

namespace hamflow {

struct SymplecticEigenvalues {
  std::vector<std::complex<double>> values;  // partners next to each other, the larger first; pairs by falling size
  double pair_defect = 0;                    // max |lambda lambda' - 1|
  double symplectic_defect = 0;              // largest entry of |M^T J M - J|
  /// The largest row sum of |M|. Rounding alone makes the defects some epsilon norm^2: an eigenvalue of size 1/norm is
  /// known to epsilon norm only.
  double norm = 0;
};

/// @param rows of a 2n x 2n matrix   @throws Error when an entry is not finite
SymplecticEigenvalues symplectic_eigenvalues(const std::vector<std::vector<double>>& rows);
/// d Psi_h^steps(z)/dz by rows; empty when a step fails.
std::vector<std::vector<double>> derivative_of_steps(const StepMap& map, State<double> z, double h, std::int64_t steps);

/// The derivative of all steps of a run, beside it. Costs like 2n Lyapunov exponents.
class MonodromyWatch final : public TangentWatch {
 public:
  MonodromyWatch(std::shared_ptr<const StepMap> map, double h, std::int64_t last_step);
  MonodromyWatch(StepMapSource source, double h, std::int64_t last_step);
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
