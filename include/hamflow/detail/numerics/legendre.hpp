// Orthonormal shifted Legendre polynomials and their integrals.   [BrugnanoIavernaroTrigiante2010, Sect. 2]
//     int_0^1 P_i P_j = delta_ij,   P_0 = 1,   I_j(c) = int_0^c P_j = xi_(j+1) P_(j+1)(c) - xi_j P_(j-1)(c),  j > 0,
//     xi_j = 1/(2 sqrt(4 j^2 - 1)),   I_0(c) = c.
// All are functions of x = c - 1/2, even or odd to the last bit, so that sums of a step over symmetric points are
// symmetric, too.
#pragma once

#include <vector>

#include "hamflow/core/math.hpp"

namespace hamflow {

/// xi_j, j > 0.
template <class R>
R legendre_step(int j) {
  return R(1) / (R(2) * sqrt(R(4) * R(j) * R(j) - R(1)));
}

/// P_0 .. P_(count - 1) at 1/2 + x.
template <class R>
std::vector<R> legendre_values(int count, const R& x) {
  std::vector<R> values;
  const R t = R(2) * x;
  R before(0);
  R value(1);
  for (int j = 0; j < count; ++j) {
    values.push_back(sqrt(R(2 * j + 1)) * value);
    const R next = (R(2 * j + 1) * t * value - R(j) * before) / R(j + 1);
    before = value;
    value = next;
  }
  return values;
}

/// I_0 - 1/2, I_1 .. I_(count - 1) at 1/2 + x. For j = 0 the integral starts at the middle, because P_0 is the only
/// polynomial with an integral other than 0 over [0, 1].
template <class R>
std::vector<R> legendre_integrals(int count, const R& x) {
  const std::vector<R> values = legendre_values<R>(count + 1, x);
  std::vector<R> integrals{x};
  for (int j = 1; j < count; ++j) {
    const auto at = static_cast<std::size_t>(j);
    integrals.push_back(legendre_step<R>(j + 1) * values[at + 1] - legendre_step<R>(j) * values[at - 1]);
  }
  return integrals;
}

}  // namespace hamflow
