// A start by energy and angular momentum: the turning points are the roots of V_eff(r) = E.   [Gross1999, (2.40)]
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "hamflow/core/error.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/problems/radial_motion.hpp"
#include "hamflow/numerics/root.hpp"

namespace hamflow {

/// The start of an orbit with energy E and angular momentum l: the innermost pericentre; the apocentre if the motion
/// reaches the centre; any point of a circle.
template <class R>
struct TurningPoint {
  R radius{};
  bool circle = false;
};

namespace detail {
/// A root of f near x with all digits of R. The search was in long double; the secant method refines it.
template <class R, class F>
R polished(const F& f, long double x) {
  if constexpr (std::is_floating_point_v<R>) {
    return static_cast<R>(x);
  } else {
    R before = R(x);
    R here = before * (R(1) + R(0x1p-50));
    R value_before = f(before);
    for (int pass = 0; pass < 64; ++pass) {  // 15 passes reach 10^4 digits
      const R value = f(here);
      const R slope = (value - value_before) / (here - before);
      const R change = value / slope;
      if (!(abs(change) <= std::numeric_limits<R>::max())) break;  // a value repeats: no further improvement
      before = here;
      value_before = value;
      here = here - change;
      if (abs(change) <= std::numeric_limits<R>::epsilon() * abs(here)) break;
    }
    return here;
  }
}
}  // namespace detail

/// @param exact, potential the potential in R and in a hardware type, which the search uses
/// @param conditions receives "V_eff <= energy" at the lowest point of V_eff, which fails if there is no orbit
/// @throws Error if the motion has no turning point
template <class R, class Exact, class Rough>
TurningPoint<R> turning_point(const Exact& exact, const Rough& potential, const R& mass, const R& energy,
                              const R& angular_momentum, Conditions& conditions) {
  using L = long double;
  const L l = static_cast<L>(angular_momentum);
  const L mu = static_cast<L>(mass);
  const L e = static_cast<L>(energy);
  const L rounding = larger(static_cast<L>(std::numeric_limits<R>::epsilon()), std::numeric_limits<L>::epsilon());
  const auto turning = [&](L r) {
    return detail::polished<R>(
        [&](const R& x) {
          return energy - exact.value(R(x * x)) - angular_momentum * angular_momentum / (R(2) * mass * x * x);
        },
        r);
  };
  const auto circular = [&](L r) {
    return detail::polished<R>(
        [&](const R& x) { return angular_momentum * angular_momentum - mass * x * x * x * x * exact.slope(R(x * x)); },
        r);
  };
  const auto effective = [&](L r) { return static_cast<L>(potential.value(r * r)) + l * l / (2 * mu * r * r); };
  const auto size = [&](L r) {
    return abs(static_cast<L>(potential.value(r * r))) + l * l / (2 * mu * r * r) + abs(e);
  };
  // V_eff does not depend on the energy, so that any state with this angular momentum gives its extrema, between which
  // V_eff is monotone.
  const RadialMotion<Rough> shape(potential, mu, Vector<L, 2>{1, 0}, Vector<L, 2>{0, l}, rounding);
  std::vector<L> radii{0x1p-60L, 0x1p60L};
  for (const CircularOrbit& at : shape.extrema()) radii.push_back(at.radius);
  std::sort(radii.begin(), radii.end());
  std::erase_if(radii, [&](L r) { return !isfinite(effective(r)); });
  if (radii.empty()) throw Error("found no radius at which V_eff is finite; allowed initial = { q, p }");

  for (const CircularOrbit& at : shape.extrema()) {
    if (at.stable && abs(effective(at.radius) - e) <= 8 * rounding * size(at.radius)) {
      return {circular(at.radius), true};
    }
  }
  const auto root_between = [&](L a, L b) {
    return bracketed_root([&](L r) { return e - effective(r); }, a, b, e - effective(a), e - effective(b));
  };
  std::optional<L> apocentre;
  for (std::size_t i = 0; i + 1 < radii.size(); ++i) {
    const bool inside = effective(radii[i]) < e;
    if (inside == (effective(radii[i + 1]) < e)) continue;
    const L root = root_between(radii[i], radii[i + 1]);
    if (!inside) return {turning(root), false};
    if (!apocentre) apocentre = root;
  }
  if (apocentre) return {turning(*apocentre), false};
  if (effective(radii.front()) < e) {
    throw Error("found an orbit without a turning point, from the centre to infinity; allowed initial = { q, p }");
  }
  const L deepest =
      *std::min_element(radii.begin(), radii.end(), [&](L a, L b) { return effective(a) < effective(b); });
  conditions.require("problem.orbit.energy", "V_eff <= energy at the lowest point of V_eff", effective(deepest), e,
                     false);
  return {static_cast<R>(deepest), true};
}
/// The start for a potential with parameters, including `mass`.
template <template <class> class Potential, class R>
TurningPoint<R> turning_point(const Parameters<R>& given, const R& energy, const R& angular_momentum,
                              Conditions& conditions) {
  using Rough = std::conditional_t<std::is_floating_point_v<R>, R, long double>;
  return turning_point<R>(Potential<R>(given), Potential<Rough>(given.template as<Rough>()), R(given["mass"]), energy,
                          angular_momentum, conditions);
}

}  // namespace hamflow
