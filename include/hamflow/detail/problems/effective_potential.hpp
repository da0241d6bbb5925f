// Properties of an orbit from the effective potential V_eff(r) = V(r) + l^2/(2 mu r^2).   [Gross1999, (2.37)-(2.44)]
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/problems/potential.hpp"
#include "hamflow/detail/problems/radial_motion.hpp"
#include "hamflow/numerics/quadrature.hpp"

namespace hamflow {

enum class OrbitType { circle, bounded_closed, bounded_open, unbounded };

inline const char* name_of(OrbitType type) {
  switch (type) {
    case OrbitType::circle:
      return "circle";
    case OrbitType::bounded_closed:
      return "bounded closed";
    case OrbitType::bounded_open:
      return "bounded open";
    case OrbitType::unbounded:
      return "unbounded";
  }
  return "";
}

struct CentralOrbit {
  OrbitType type = OrbitType::unbounded;
  std::string conic{};  // "circle", "ellipse", "parabola", "hyperbola", "line"; empty if it is not a conic
  long double energy = 0;
  long double angular_momentum = 0;  // 0 if it is only rounding
  long double r_min = 0;             // turning points; 0 if the centre is reached
  long double r_max = 0;             // infinity if the motion is unbounded
  /// The radius of the circular orbit with this angular momentum; 0 if there is none. It is at the deepest minimum of
  /// V_eff between the turning points or, if there is no minimum, at the extremum of V_eff nearest by the ratio of
  /// radii.
  long double circular_radius = 0;
  bool circular_stable = false;  // V_eff'' > 0
  /// The angle from pericentre to apocentre, half of (2.43), not negative. Special cases: on unbounded orbits, from
  /// pericentre to infinity; on a stable circle, that of the small oscillation; on an unstable circle, and on orbits
  /// that approach one for ever, infinite; on a line through the centre pi/2, which is the limit of small l; 0 if the
  /// phase does not change. If the motion ends in the centre, the angle from there to apocentre or to infinity. It is
  /// infinite for a spiral with infinitely many revolutions, or with more than the quadrature resolves.
  long double apsidal_angle = 0;
  /// The time from pericentre to pericentre; infinite on unbounded orbits, unstable circles and separatrices. If the
  /// motion reaches the centre, twice the time from apocentre to the centre; for a fall on a line this is the limit of
  /// thin ellipses.
  long double radial_period = 0;
  /// Whether the orbit closes (2.44): apsidal angle/pi = revolutions/radial_periods. A circle closes after one
  /// revolution. radial_periods is then the number of small oscillations per revolution, or 0 if that is not whole.
  bool closed = false;
  int revolutions = 0;
  int radial_periods = 0;
  bool falls_into_centre = false;  // the motion ends there: V has no finite value at r = 0
};

/// Returns the fraction with the smallest denominator within `tolerance` of x >= 0; nullopt if the denominator exceeds
/// `largest`. A fraction closer than 1/(2 denominator^2) is a convergent of the continued fraction of x.
inline std::optional<std::pair<int, int>> commensurable(long double x, int largest, long double tolerance) {
  long double p = 1;
  long double q = 0;
  long double previous_p = 0;
  long double previous_q = 1;
  long double rest = x;
  while (rest < 1e7L) {
    const long double whole = static_cast<long double>(static_cast<long long>(rest));
    previous_p = std::exchange(p, whole * p + previous_p);
    previous_q = std::exchange(q, whole * q + previous_q);
    if (q > static_cast<long double>(largest)) break;
    if (abs(x - p / q) <= tolerance) return std::pair{static_cast<int>(p), static_cast<int>(q)};
    rest = 1 / (rest - whole);
  }
  return std::nullopt;
}

/// The largest number of radial periods after which an orbit counts as closed.
inline constexpr int most_radial_periods = 32;

namespace detail {
template <class Potential>
void add_circular_orbit(const RadialMotion<Potential>& motion, CentralOrbit& orbit) {
  const CircularOrbit* best = nullptr;
  for (const CircularOrbit& candidate : motion.extrema()) {
    const auto inside = [&](const CircularOrbit& at) {
      return at.stable && orbit.r_min <= at.radius && at.radius <= orbit.r_max;
    };
    const auto remoteness = [&](const CircularOrbit& at) { return abs(log(at.radius / motion.radius())); };
    if (best == nullptr || (inside(candidate) && !inside(*best)) ||
        (inside(candidate) == inside(*best) &&
         (inside(candidate) ? motion.above(candidate.radius) > motion.above(best->radius)
                            : remoteness(candidate) < remoteness(*best)))) {
      best = &candidate;
    }
  }
  if (best == nullptr) return;
  orbit.circular_radius = best->radius;
  orbit.circular_stable = best->stable;
}

/// Returns the phase between the centre, where the motion ends, and apocentre or infinity. It is infinite if V is not
/// steeper than -1/r^2, because the integrand is then like 1/r and the quadrature does not converge. It is also
/// reported as infinite if the quadrature cannot resolve a finite value: for V like r^-2.001, and slightly above a
/// maximum of V_eff.
template <class Potential>
long double phase_from_centre(const RadialMotion<Potential>& motion, const RadialClock<Potential>& clock) {
  using L = long double;
  constexpr L settled = 1e-6L;  // relative
  std::vector<Integral> parts;
  if (motion.r_max() < motion.infinity) {
    parts.push_back(integrate_from_ends([&](L x, L rest) { return clock.at(x, rest).phase; }, clock.end()));
  } else {  // integrates over r up to the radius of the state, and over s = 1/r beyond it
    const L middle = motion.radius();
    parts.push_back(integrate_from_ends([&](L r, L) { return clock.at(r).phase; }, middle));
    parts.push_back(integrate_from_ends([&](L s, L) { return clock.at(1 / s).phase / s / s; }, 1 / middle));
  }
  L sum = 0;
  for (const Integral& part : parts) {
    if (!(part.error <= settled * abs(part.value))) return motion.infinity;
    sum += abs(part.value);
  }
  return sum;
}
}  // namespace detail

/// Describes the orbit through (q, p), computed in long double. An angular momentum, the distance from a circle and the
/// energy of a parabola count as 0 if they are below the rounding of R, the type of the state.
///
/// The apsidal angle counts as commensurable within 1024 roundings of R. The tolerance has to be larger than one
/// rounding, because the rounding of the state changes the angle. It also has to be small: by chance, an angle is
/// within it of a fraction with a denominator up to 32 with the probability (3/pi^2) 32^2 * 2 * 1024 roundings, 1.4e-10
/// in double.
template <class R, class Potential>
CentralOrbit describe_central_orbit(const Potential& potential, R mass, const Vector<R, 2>& q, const Vector<R, 2>& p) {
  using L = long double;
  const L rounding = static_cast<L>(std::numeric_limits<R>::epsilon());
  const L infinity = std::numeric_limits<L>::infinity();
  const RadialMotion<Potential> motion(potential, static_cast<L>(mass), cast<L>(q), cast<L>(p), rounding);
  CentralOrbit orbit;
  const L l = orbit.angular_momentum = motion.angular_momentum();
  orbit.energy = abs(motion.energy()) <= motion.energy_rounding() ? L(0) : motion.energy();
  orbit.r_min = motion.r_min();
  orbit.r_max = motion.r_max();
  detail::add_circular_orbit(motion, orbit);
  const bool finite_centre = isfinite(potential.value(L(0)));
  orbit.falls_into_centre = !motion.circular() && orbit.r_min == 0 && !(l == 0 && finite_centre);

  if (motion.circular()) {
    const L r = motion.radius();
    orbit.type = OrbitType::circle;
    orbit.circular_radius = r;
    L curvature = r > 0 ? motion.effective_curvature(r) : L(1);
    // V = a/r^2: no circle is stable, but rounding could make it appear so.
    if (r > 0 && curvature <= 8 * rounding * motion.size_of_curvature(r)) curvature = 0;
    orbit.circular_stable = curvature > 0;
    const L radial_rate = curvature > 0 ? sqrt(curvature / static_cast<L>(mass)) : L(0);
    orbit.radial_period = 2 * pi_value<L>() / radial_rate;
    orbit.apsidal_angle = l == 0 ? L(0) : pi_value<L>() * abs(l) / (static_cast<L>(mass) * r * r) / radial_rate;
    orbit.closed = true;
    orbit.revolutions = l == 0 ? 0 : 1;  // at rest there is no revolution
    const auto ratio = commensurable(orbit.apsidal_angle / pi_value<L>(), most_radial_periods, 1024 * rounding);
    if (ratio && ratio->first == orbit.revolutions && orbit.radial_period < infinity) {
      orbit.radial_periods = ratio->second;
    }
  } else {
    const RadialClock<Potential> clock(motion, static_cast<L>(mass));
    if (!(orbit.r_max < infinity)) {
      orbit.type = OrbitType::unbounded;
      orbit.radial_period = infinity;
      if (l != 0 && orbit.r_min > 0) {
        orbit.apsidal_angle = motion.separatrix() ? infinity : abs(clock.phase_to_infinity());
      } else if (l != 0) {
        orbit.apsidal_angle = detail::phase_from_centre(motion, clock);
      }
    } else if (motion.separatrix()) {
      orbit.type = OrbitType::bounded_open;
      orbit.radial_period = infinity;
      orbit.apsidal_angle = l == 0 ? L(0) : infinity;
    } else {
      orbit.radial_period = 2 * clock.time(clock.end());
      if (orbit.r_min > 0) {
        orbit.apsidal_angle = l == 0 ? L(0) : abs(clock.phase(clock.end()));
      } else if (!orbit.falls_into_centre) {
        orbit.apsidal_angle = pi_value<L>() / 2;
      } else if (l != 0) {
        orbit.apsidal_angle = detail::phase_from_centre(motion, clock);
      }
      if (!orbit.falls_into_centre) {
        if (const auto ratio =
                commensurable(orbit.apsidal_angle / pi_value<L>(), most_radial_periods, 1024 * rounding)) {
          orbit.closed = true;
          orbit.revolutions = ratio->first;
          orbit.radial_periods = ratio->second;
        }
      }
      orbit.type = orbit.closed ? OrbitType::bounded_closed : OrbitType::bounded_open;
    }
  }
  if constexpr (potentials::HasConic<Potential>) {
    orbit.conic = potential.conic(motion.circular(), orbit.energy == 0 ? 0 : orbit.energy > 0 ? 1 : -1, l == 0);
  }
  return orbit;
}

}  // namespace hamflow
