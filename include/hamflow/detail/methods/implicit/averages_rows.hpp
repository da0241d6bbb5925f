// Functions shared by the solvers for averages: rows of numbers, one row for each average, and the functions that
// Newton needs.
#pragma once

#include "hamflow/detail/methods/implicit/averages.hpp"
#include "hamflow/detail/methods/implicit/energy_gain.hpp"
#include "hamflow/detail/methods/implicit/newton.hpp"
#include "hamflow/detail/methods/implicit/points.hpp"

namespace hamflow::detail {

/// The values at one set of averages.
template <class Real>
struct AveragesPoint {
  using Numbers = Vector<Real, dynamic>;
  Numbers residual{};
  Numbers sum{};         // kappa sum_l W_il f(y_l)
  Numbers target{};      // the averages that follow from it, h/kappa times the sum
  Numbers noise{};       // rounding of the target in units of epsilon, entry by entry
  Numbers curvatures{};  // sums of second derivatives, for the Jacobian
  Matrix<Real, dynamic> tangent{};
  bool linearised = true;  // evaluate() computes the Jacobian, too
};

template <class Real>
void clear(Vector<Real, dynamic>& x, std::size_t size) {
  if (x.size() != size) {
    x = Vector<Real, dynamic>(size);
  } else {
    for (Real& each : x) each = Real(0);
  }
}

/// @param second number of summed second derivatives
template <class Real>
void clear(AveragesPoint<Real>& at, std::size_t size, std::size_t second) {
  clear(at.sum, size);
  clear(at.noise, size);
  if (at.target.size() != size) at.target = at.residual = at.sum;
  if (!at.linearised) return;
  clear(at.curvatures, second);
  if (at.tangent.size() != size) at.tangent = Matrix<Real, dynamic>(size);
}

/// The averages of the polynomial that extrapolates the last step.
template <class Real>
Vector<Real, dynamic> continued(const AverageTable<Real>& table, const Vector<Real, dynamic>& last) {
  const auto k = static_cast<std::size_t>(table.averages);
  Vector<Real, dynamic> x(last.size());
  for (std::size_t a = 0; a < x.size(); a += k) {
    for (std::size_t j = 0; j < k; ++j) {
      for (std::size_t i = 0; i < k; ++i) x[a + i] += table.next[j * k + i] * last[a + j];
    }
  }
  return x;
}

/// x += sum_j e_j u_j/2 for the coordinates from number `from` on.
template <class Real, std::size_t N>
void add_half_increment(const AverageTable<Real>& table, const Vector<Real, dynamic>& u, std::size_t from,
                        Vector<Real, N>& x) {
  const auto k = static_cast<std::size_t>(table.averages);
  for (std::size_t a = 0; a < x.size(); ++a) {
    Real sum(0);
    for (std::size_t j = 0; j < k; ++j) sum += table.increment[j] * u[(from + a) * k + j];
    x[a] += sum / Real(2);
  }
}

/// Points first .. first + count - 1 of a table, middle + sum_j N_lj u_j, in the layout of points.hpp.
template <class Real, std::size_t N>
void place_points(const AverageTable<Real>& table, const Vector<Real, dynamic>& u, std::size_t from, std::size_t first,
                  std::size_t count, const Vector<Real, N>& middle, Real* x) {
  const auto s = static_cast<std::size_t>(table.points);
  const auto k = static_cast<std::size_t>(table.averages);
  for (std::size_t a = 0; a < middle.size(); ++a) {
    Real sum[point_stride];
    const Real* const inner = table.inner.data() + first;
    const Real* const each = &u[(from + a) * k];
    for (std::size_t l = 0; l < count; ++l) sum[l] = inner[l] * each[0];
    for (std::size_t j = 1; j < k; ++j) {
      for (std::size_t l = 0; l < count; ++l) sum[l] += inner[j * s + l] * each[j];
    }
    for (std::size_t l = 0; l < count; ++l) x[a * point_stride + l] = middle[a] + sum[l];
  }
}

/// Adds sign * kappa sum_l W_il f_l to the sums, and |h| sum_l |W_il| size_l to the noise, for the coordinates from
/// number `from` on.
/// @param f, size rows of a block of points
template <class Real>
void add_averages(const AverageTable<Real>& table, std::size_t first, std::size_t count, const Real& h,
                  const Real& sign, const Real* f, const Real* size, std::size_t from, std::size_t coordinates,
                  AveragesPoint<Real>& at) {
  const auto k = static_cast<std::size_t>(table.averages);
  for (std::size_t a = 0; a < coordinates; ++a) {
    Real* const sum = &at.sum[(from + a) * k];
    Real* const noise = &at.noise[(from + a) * k];
    for (std::size_t l = 0; l < count; ++l) {
      const Real value = sign * f[a * point_stride + l];
      const Real length = abs(h) * size[a * point_stride + l];
      const std::size_t row = (first + l) * k;
      if (table.diagonal) {
        sum[first + l] = table.unit_weight[row + first + l] * value;
        noise[first + l] = table.weight[row + first + l] * length;
        continue;
      }
      for (std::size_t i = 0; i < k; ++i) {
        sum[i] += table.unit_weight[row + i] * value;
        noise[i] += abs(table.weight[row + i]) * length;
      }
    }
  }
}

/// curvatures += sum_l factor_l,ij second_l, k k numbers.
/// @param factor from a table @param second one row of a block of points
template <class Real>
void add_curvatures(const std::vector<Real>& factor, std::size_t k, std::size_t first, std::size_t count,
                    const Real* second, Real* curvatures) {
  for (std::size_t l = 0; l < count; ++l) {
    const Real* const row = factor.data() + (first + l) * k * k;
    for (std::size_t ij = 0; ij < k * k; ++ij) curvatures[ij] += row[ij] * second[l];
  }
}

/// Computes target and residual from the complete sum. The residual does not have the rounding of the product, see
/// natural.hpp.
template <class Real>
void close(AveragesPoint<Real>& at, const Real& unit, const Vector<Real, dynamic>& x) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    at.target[i] = unit * at.sum[i];
    at.residual[i] = (at.target[i] - x[i]) + product_error(unit, at.sum[i], at.target[i]);
  }
}

/// x <- the target at x + correction, rounded once, see natural.hpp. With the Jacobian K this is exact to second order:
/// the target changes by correction - K correction. Without a Jacobian x + correction is the target.
template <class Real>
void move_to_target(Vector<Real, dynamic>& x, const AveragesPoint<Real>& at, const Real& unit,
                    const Vector<Real, dynamic>& correction) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    Real change(0);
    if (at.tangent.size() > 0) {
      change = correction[i];
      for (std::size_t j = 0; j < x.size(); ++j) change -= at.tangent[i][j] * correction[j];
    }
    x[i] = at.target[i] + (product_error(unit, at.sum[i], at.target[i]) + change);
  }
}

/// The largest correction in units of its noise, because entries may have different units.
template <class Real>
Correction<Real> in_units_of_noise(const Vector<Real, dynamic>& x, const AveragesPoint<Real>& at,
                                   const Vector<Real, dynamic>& correction) {
  constexpr auto epsilon = Epsilon<Real>{};
  Real distance(0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Real unit = epsilon * Real(at.noise[i] + abs(x[i]));
    distance = larger_size(distance, hamflow::in_units_of_noise(Real(abs(correction[i])), unit));
  }
  return {distance, Real(1)};
}

/// The size of the terms if their rounding hides the unknowns, see hidden_by_rounding; else 0. Fixed-point iteration
/// does not need it: its correction is the residual, which is small only at a solution.
template <class Real>
Real hiding_terms(const Vector<Real, dynamic>& x, const AveragesPoint<Real>& at,
                  const Vector<Real, dynamic>& correction) {
  if (at.tangent.size() == 0) return Real(0);
  constexpr auto epsilon = Epsilon<Real>{};
  Real unit(0);
  Real unknown(0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    unit = larger(unit, Real(epsilon * Real(at.noise[i] + abs(x[i]))));
    unknown = larger(unknown, Real(abs(x[i] + correction[i])));
  }
  return hidden_by_rounding(unit, unknown) ? sum_of(at.noise) : Real(0);
}

template <class R, std::size_t N>
R two_norm(const Vector<R, N>& all) {
  R sum(0);
  for (const R& each : all) sum += each * each;
  return sqrt(sum);
}

/// A sum of several terms with its rounding error.   [Knuth1997, 4.2.2]
template <class Real>
struct CompensatedSum {
  Real high{0};
  Real low{0};
  void add(const Real& x) {
    const Real sum = high + x;
    const Real part = sum - high;
    low += (high - (sum - part)) + (x - part);
    high = sum;
  }
};

}  // namespace hamflow::detail
