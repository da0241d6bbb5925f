// Base of equations of the form x = (h/kappa) s(x): unknowns x in dynamic rows, their target (h/kappa) s, the residual
// target - x, and the Jacobian 1 - d target/dx. Rounding is treated as in natural.hpp: the product with h/kappa is
// rounded once, together with the last correction.
#pragma once

#include "hamflow/detail/methods/implicit/newton.hpp"
#include "hamflow/detail/methods/implicit/segment.hpp"
#include "hamflow/detail/numerics/exact_product.hpp"

namespace hamflow {

/// The values at one x.
template <class Real>
struct TargetPoint {
  using Rows = Vector<Real, dynamic>;
  Rows residual{};
  Rows sum{};     // s
  Rows target{};  // (h/kappa) s
  Rows noise{};   // rounding of the target in units of epsilon, entry by entry: sizes of terms, not of sums
  Matrix<Real, dynamic> tangent{};  // 1 - d target/dx
  bool linearised = true;           // evaluate() computes noise of second order and the Jacobian, too
};

/// The functions of such equations that Newton needs.
template <class Real>
class TargetEquations {
 public:
  using Variables = Vector<Real, dynamic>;
  using Point = TargetPoint<Real>;

  const Matrix<Real, dynamic>& tangent(const Point& at) const { return at.tangent; }
  Real norm(const Variables&, const Point& at) const {
    Real sum(0);
    for (const Real& r : at.residual) sum += r * r;
    return sqrt(sum);
  }
  /// The largest correction in units of its noise, because entries may have different units. The correction of an entry
  /// that was 0 counts as large as the entry, because an overestimate would make the next correction look too good.
  Correction<Real> measure(const Variables& x, const Point& at, const Variables& correction) const {
    constexpr auto epsilon = Epsilon<Real>{};
    Real distance(0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Real size = abs(correction[i]);
      const Real unit = epsilon * larger(Real(at.noise[i] + abs(x[i])), size);
      if (!(unit <= std::numeric_limits<Real>::max()))
        return {unit, Real(1)};  // no correction is small if the noise is infinite
      const Real here = size / larger(unit, std::numeric_limits<Real>::min());
      distance = here <= distance ? distance : here;
    }
    return {distance, Real(1)};
  }

  /// The size of the terms if their rounding is far larger than that of the step, else 0. At an iterate near a
  /// singularity, where forces round by more than the whole step, any correction and any residual look small; at the
  /// next iterate, away from it, they do not. Newton's last correction is about 10^-8 of a step, and the remaining
  /// residual is that times the stiffness.
  Real hidden_terms(const Variables& x, const Point& at, const Variables& correction) const {
    Real step(0);
    Real moved(0);
    Real left(0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      step = larger(step, Real(abs(x[i])));
      moved = larger(moved, Real(abs(correction[i])));
      left = larger(left, Real(abs(at.residual[i])));
    }
    const bool hidden = moved > step / (1 << 20) || left > step / (1 << 10);
    return hidden ? detail::sum_of(at.noise) : Real(0);
  }

 protected:
  explicit TargetEquations(const Real& h) : h_(h), unit_(h / detail::golden_ratio<Real>()) {}

  /// Sets all values to zero, and the Jacobian if it is requested.
  static void clear(Point& at, std::size_t size) {
    at.sum = Variables(size);
    at.noise = at.sum;
    at.target = at.residual = at.sum;
    at.tangent = at.linearised ? Matrix<Real, dynamic>(size) : Matrix<Real, dynamic>();
  }
  /// Computes target and residual from the complete sum.
  void close(const Variables& x, Point& at) const {
    for (std::size_t i = 0; i < x.size(); ++i) {
      at.target[i] = unit_ * at.sum[i];
      at.residual[i] = (at.target[i] - x[i]) + product_error(unit_, at.sum[i], at.target[i]);
    }
  }
  /// x <- the target at x + correction, rounded once; to second order with a Jacobian. With a Jacobian from an earlier
  /// iteration, or none, its product with the correction is the residual.
  void move_to_target(Variables& x, const Point& at, const Variables& correction) const {
    for (std::size_t i = 0; i < x.size(); ++i) {
      Real change = correction[i] - at.residual[i];
      if (at.tangent.size() > 0) {
        change = correction[i];
        for (std::size_t j = 0; j < x.size(); ++j) change -= at.tangent[i][j] * correction[j];
      }
      x[i] = at.target[i] + (product_error(unit_, at.sum[i], at.target[i]) + change);
    }
  }

  const Real h_;
  const Real unit_;  // h/kappa, see detail::golden_ratio
};

}  // namespace hamflow
