// The potential energy of soft walls, for starts of given energy and for the energy of a state.
#pragma once

#include <cstddef>
#include <limits>

#include "hamflow/core/math.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

/// V = k w/(2 (e - 1)) (1 - x^2)^(1 - e), for e = 1 -(k w/2) ln(1 - x^2), with x = (q - middle)/w for each wall; 0 for
/// hard walls. NaN if q is on or beyond a wall. Its derivative is the force of walled_functions.cpp, k x/(1 - x^2)^e.
/// @param q all coordinates, in any container
template <class R, class Q>
R soft_energy(const Walls& walls, const Q& q) {
  R sum(0);
  if (walls.hard()) return sum;
  const R k = evaluate_number<R>(walls.strength);
  const R e = evaluate_number<R>(walls.exponent);
  for (const Walls::Interval& wall : walls.intervals) {
    const R min = evaluate_number<R>(wall.min);
    const R max = evaluate_number<R>(wall.max);
    const R w = (max - min) / R(2);
    const R x = (q[wall.index] - (min + max) / R(2)) / w;
    const R u = R(1) - x * x;
    if (!(u > R(0))) return std::numeric_limits<R>::quiet_NaN();
    sum += e == R(1) ? R(-k * w / R(2) * log(u)) : R(k * w / (R(2) * (e - R(1))) * pow(u, R(R(1) - e)));
  }
  return sum;
}

}  // namespace hamflow
