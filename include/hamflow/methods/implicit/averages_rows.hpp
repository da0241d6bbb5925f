// What the solvers for averages do alike: rows of numbers, one row for each average, and what Newton asks of them.
#pragma once

#include "hamflow/methods/implicit/averages.hpp"
#include "hamflow/methods/implicit/points.hpp"

namespace hamflow::detail {

/// What is known at one set of averages.
template <class Real>
struct AveragesPoint {
  using Rows = Vector<Real, dynamic>;
  Rows residual{};
  Rows sum{};     // kappa sum_l W_il f(y_l)
  Rows target{};  // what the averages should be, h/kappa times that
  Rows noise{};   // what the target rounds by, in units of epsilon, entry by entry
  Matrix<Real, dynamic> tangent{};
  bool linearised = true;  // evaluate() is to compute the tangent, too
};

template <class Real>
void clear(Vector<Real, dynamic>& x, std::size_t size) {
  if (x.size() != size) x = Vector<Real, dynamic>(size);
  for (Real& each : x) each = Real(0);
}

template <class Real>
void clear(AveragesPoint<Real>& at, std::size_t size) {
  clear(at.sum, size);
  clear(at.noise, size);
  if (at.target.size() != size) at.target = at.residual = at.sum;
  if (!at.linearised) return;
  if (at.tangent.size() != size) at.tangent = Matrix<Real, dynamic>(size);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) at.tangent[i][j] = Real(0);
  }
}

/// From the averages of the last step those of the polynomial motion that continues it; a row has `size` numbers.
template <class Real>
Vector<Real, dynamic> continued(const AverageTable<Real>& table, const Vector<Real, dynamic>& last, std::size_t size) {
  const auto k = static_cast<std::size_t>(table.averages);
  Vector<Real, dynamic> x(k * size);
  for (std::size_t i = 0; i < k; ++i) {
    for (std::size_t j = 0; j < k; ++j) {
      const Real& factor = table.next[i * k + j];
      if (factor == Real(0)) continue;
      for (std::size_t a = 0; a < size; ++a) x[i * size + a] += factor * last[j * size + a];
    }
  }
  return x;
}

/// x += sum_j e_j u_j/2. Rows of u have `row` numbers, of which `size` from `from` on are those of x.
template <class Real, std::size_t N>
void add_half_increment(const AverageTable<Real>& table, const Vector<Real, dynamic>& u, std::size_t row,
                        std::size_t from, std::size_t size, Vector<Real, N>& x) {
  for (std::size_t j = 0; j < table.increment.size(); ++j) {
    if (table.increment[j] == Real(0)) continue;
    const Real half = table.increment[j] / Real(2);
    for (std::size_t a = 0; a < size; ++a) x[a] += half * u[j * row + from + a];
  }
}

/// Points first .. first + count - 1 of a table, middle + sum_j N_lj u_j, as points.hpp has them.
template <class Real, std::size_t N>
void place_points(const AverageTable<Real>& table, const Vector<Real, dynamic>& u, std::size_t row, std::size_t from,
                  std::size_t first, std::size_t count, const Vector<Real, N>& middle, Real* x) {
  const auto s = static_cast<std::size_t>(table.points);
  for (std::size_t a = 0; a < middle.size(); ++a) {
    Real* const out = x + a * point_stride;
    for (std::size_t l = 0; l < count; ++l) out[l] = table.inner[first + l] * u[from + a];
    for (std::size_t j = 1; j < table.increment.size(); ++j) {
      const Real& each = u[j * row + from + a];
      for (std::size_t l = 0; l < count; ++l) out[l] += table.inner[j * s + first + l] * each;
    }
    for (std::size_t l = 0; l < count; ++l) out[l] = middle[a] + out[l];
  }
}

/// target and residual of a sum that is complete. The residual is without the rounding of the product, see natural.hpp.
template <class Real>
void close(AveragesPoint<Real>& at, const Real& unit, const Vector<Real, dynamic>& x) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    at.target[i] = unit * at.sum[i];
    at.residual[i] = (at.target[i] - x[i]) + product_error(unit, at.sum[i], at.target[i]);
  }
}

/// x <- the target at x + correction. With the tangent K to second order: the target changes by correction - K
/// correction; without one by nothing, since x + correction is the target. Rounded once, see natural.hpp.
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

/// The largest correction in units of its noise: entries have units of their own.
template <class Real>
Correction<Real> in_units_of_noise(const Vector<Real, dynamic>& x, const AveragesPoint<Real>& at,
                                   const Vector<Real, dynamic>& correction) {
  constexpr auto epsilon = Epsilon<Real>{};
  Real distance(0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Real size = abs(correction[i]);
    Real unit = epsilon * Real(at.noise[i] + abs(x[i]));
    if (!(unit > epsilon * Real(epsilon * size))) unit = epsilon * size;  // at 0 so far, without noise of its own
    const Real here = size / larger(unit, std::numeric_limits<Real>::min());
    distance = here <= distance ? distance : here;
  }
  return {distance, Real(1)};
}

template <class Real>
Real two_norm(const Vector<Real, dynamic>& x) {
  Real sum(0);
  for (const Real& each : x) sum += each * each;
  return sqrt(sum);
}

/// A sum of several terms and what its rounding has lost.   [Knuth1997, 4.2.2]
template <class Real>
struct KeptSum {
  Real high{0};
  Real low{0};
  void add(const Real& x) {
    const Real sum = high + x;
    const Real part = sum - high;
    low += (high - (sum - part)) + (x - part);
    high = sum;
  }
};

/// The rounding of a sum of work, that of its terms and that of the coordinates at which forces are evaluated, which adds
/// up as independent roundings do.
template <class Real>
struct RoundingOfWork {
  Real works{0};
  Real bends{0};
  /// @param bend (V'' d) q: the change of a force along the step times the coordinate
  void add(const Real& work, const Real& bend) {
    works += work * work;
    bends += bend * bend;
  }
  Real of_terms(int terms) const {
    constexpr auto epsilon = Epsilon<Real>{};
    return epsilon * Real(Real(terms) * sqrt(works) + Real(4) * sqrt(bends));
  }
};

/// What points see of the energy that a step gains, and what rounding makes of it.
template <class Real>
struct Gain {
  Real gain{0};
  Real size{0};   // of its terms
  Real noise{0};  // that rounding explains
};

/// Whether a step gains energy that is no rounding: one more point sees more than rounding explains, and two more see
/// the same. Where the estimate of rounding is too small, they see different noise.
/// @param gain of the step as the points of a table see it
template <class Real, class SeenBy>
bool gains_energy(const AverageSetup<Real>& setup, const SeenBy& gain) {
  const Gain<Real> one = gain(setup.finer());
  if (abs(one.gain) <= one.noise) return false;
  if (abs(one.gain) > Real(4096) * one.noise || !setup.has_finest()) return true;
  return abs(gain(setup.finest()).gain - one.gain) <= abs(one.gain) / 2;
}

}  // namespace hamflow::detail
