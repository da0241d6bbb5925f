// A start by energy and angular momentum: the turning points are the roots of V_eff(r) = E.   [Gross1999, (2.40)]
#pragma once

#include <optional>

#include "hamflow/core/error.hpp"
#include "hamflow/problems/support/radial_motion.hpp"

namespace hamflow {

/// Where an orbit with energy E and angular momentum l begins: at pericentre; where it has none, at apocentre; on a
/// circle anywhere. Of several allowed intervals of r the innermost counts.
template <class R>
struct TurningPoint {
  R radius{};
  bool circle = false;
};

/// @param conditions receives "V_eff <= energy" at the deepest point of V_eff, which fails where there is no orbit
/// @throws Error when the motion has no turning point
template <class Potential, class R>
TurningPoint<R> turning_point(const Potential& potential, const R& mass, const R& energy, const R& angular_momentum,
                              Conditions& conditions) {
  using L = long double;
  const L l = static_cast<L>(angular_momentum);
  const L mu = static_cast<L>(mass);
  const L e = static_cast<L>(energy);
  constexpr L rounding = std::numeric_limits<R>::epsilon();
  const auto centrifugal = [&](L r) { return l * l / (2 * mu * r * r); };
  const auto effective = [&](L r) { return static_cast<L>(potential.value(r * r)) + centrifugal(r); };
  const auto size = [&](L r) { return abs(static_cast<L>(potential.value(r * r))) + centrifugal(r); };
  // The shape of V_eff is the same for every energy: any state of this angular momentum shows its extrema.
  const RadialMotion<Potential> shape(potential, mu, Vector<L, 2>{1, 0}, Vector<L, 2>{0, l}, rounding);
  std::vector<L> candidates{0x1p-60L};
  for (const CircularOrbit& at : shape.extrema()) candidates.push_back(at.radius);
  for (const L r : {0x1p-20L, 1.0L, 0x1p20L, 0x1p60L}) candidates.push_back(r);
  std::stable_sort(candidates.begin(), candidates.end());
  std::optional<L> inside;
  L deepest = candidates.front();
  for (const L r : candidates) {
    if (!isfinite(effective(r))) continue;
    if (!isfinite(effective(deepest)) || effective(r) < effective(deepest)) deepest = r;
    if (!inside && effective(r) <= e + 8 * rounding * (size(r) + abs(e))) inside = r;
  }
  if (!inside) {
    conditions.require("problem.orbit.energy", "V_eff <= energy at the minimum of V_eff", effective(deepest), e, false);
    return {static_cast<R>(deepest), true};
  }
  if (abs(effective(*inside) - e) <= 8 * rounding * (size(*inside) + abs(e))) {
    for (const CircularOrbit& at : shape.extrema()) {
      if (at.radius == *inside) return {static_cast<R>(*inside), true};
    }
  }
  const L radial = sqrt(larger(L(0), 2 * mu * (e - effective(*inside))));
  const RadialMotion<Potential> motion(potential, mu, Vector<L, 2>{*inside, 0}, Vector<L, 2>{radial, l / *inside},
                                       rounding);
  if (motion.r_min() > 0) return {static_cast<R>(motion.r_min()), false};
  if (motion.r_max() < std::numeric_limits<L>::infinity()) return {static_cast<R>(motion.r_max()), false};
  throw Error("found an orbit without a turning point, from the centre to infinity; allowed initial = { q, p }");
}

}  // namespace hamflow
