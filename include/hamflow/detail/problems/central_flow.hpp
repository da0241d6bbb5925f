// The exact flow in time in any central potential: t(r) and phi(r) by quadrature, t(r) inverted. Whole radial periods
// are subtracted first. Everything is in long double.   [Gross1999, (2.29), (2.39)]
#pragma once

#include <optional>

#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/problems/radial_motion.hpp"

namespace hamflow {

namespace detail {

/// A state in polar form: r, phase, r' with its sign. On lines through the centre `side` is -1 beyond the centre.
struct PolarState {
  long double r = 0;
  long double phase = 0;
  long double radial_velocity = 0;
  long double side = 1;
};

/// The state at a time before or after an apsis, `since` = -half .. half.
template <class Potential>
PolarState after(const RadialMotion<Potential>& motion, const RadialClock<Potential>& clock, long double t) {
  using L = long double;
  using From = typename RadialClock<Potential>::From;
  const L outward = motion.radial_velocity() < 0 ? L(-1) : L(1);
  const L start = clock.start();
  PolarState state;
  if (clock.from() == From::centre_to_infinity) {
    const L since = outward * clock.time(start) + t;
    const bool through = since * outward < 0;
    const L x = clock.when(abs(since));
    const auto at = clock.at(x);
    state.r = at.r;
    state.side = through ? L(-1) : L(1);
    state.radial_velocity = (since < 0 ? L(-1) : L(1)) * at.speed;
    if (motion.angular_momentum() != 0) state.phase = outward * clock.phase(start, x);
    return state;
  }
  // If the motion starts at apocentre, time counts from there and the radius decreases.
  const L sense = clock.from() == From::apocentre_to_centre ? L(-1) : L(1);
  const bool through_centre = sense < 0;
  L since = sense * outward * clock.time(start) + t;
  if (clock.from() != From::pericentre_to_infinity) {
    const L half = clock.time(clock.end()) * (through_centre ? L(2) : L(1));
    const L periods = nearbyint(since / (2 * half));
    since -= 2 * half * periods;
    if (!through_centre) state.phase = 2 * periods * clock.phase(clock.end());
    if (through_centre && abs(since) > half / 2) {  // beyond the centre, symmetrical
      state.side = -1;
      since = (since < 0 ? L(-1) : L(1)) * (half - abs(since));
    }
  }
  const L x = clock.when(abs(since));
  const auto at = clock.at(x);
  const L now = since < 0 ? L(-1) : L(1);
  state.r = at.r;
  state.radial_velocity = now * sense * state.side * at.speed;
  if (motion.angular_momentum() != 0) {
    state.phase += now * clock.phase(x) - sense * outward * clock.phase(start);
  }
  return state;
}

/// Whether a motion that reaches the centre does so between now and t.
template <class Potential>
bool meets_centre(const RadialMotion<Potential>& motion, const RadialClock<Potential>& clock, long double t) {
  using L = long double;
  if (motion.r_min() > 0) return false;
  const L outward = motion.radial_velocity() < 0 ? L(-1) : L(1);
  const L from_apsis = clock.time(clock.start());
  if (!(motion.r_max() < motion.infinity)) return outward * (outward * from_apsis + t) < 0;
  return abs(t - outward * from_apsis) >= clock.time(clock.end());
}

/// Whether the motion passes a maximum of V_eff so slowly that the quadrature over time does not resolve it: at the
/// maximum the radial energy is less than the decrease of V_eff within a twentieth of the radius.
template <class Potential>
bool near_separatrix(const RadialMotion<Potential>& motion) {
  for (const CircularOrbit& at : motion.extrema()) {
    if (at.stable || at.radius < motion.r_min() || at.radius > motion.r_max()) continue;
    const long double width = at.radius / 20;
    if (motion.above(at.radius) < -motion.effective_curvature(at.radius) / 2 * width * width) return true;
  }
  return false;
}

}  // namespace detail

/// The state after time t. It is empty if the motion ends in a singular centre or at infinity, on or near a separatrix
/// or an unstable circle, where rounding decides, and if a quadrature does not converge because the terms of V_eff
/// cancel, as for -1/r^2.
template <class Potential>
std::optional<Start<long double, 2>> central_flow(const Potential& potential, long double mass,
                                                  const Vector<long double, 2>& q, const Vector<long double, 2>& p,
                                                  long double t) {
  using L = long double;
  const RadialMotion<Potential> motion(potential, mass, q, p, std::numeric_limits<L>::epsilon());
  const L l = motion.angular_momentum();
  const L r0 = motion.radius();
  detail::PolarState now;
  if (motion.circular()) {
    if (r0 > 0 && !(motion.effective_curvature(r0) > 0)) return std::nullopt;  // unstable: rounding decides
    now.r = r0;
    now.phase = r0 > 0 ? l / (mass * r0 * r0) * t : L(0);
  } else {
    if (motion.separatrix() || detail::near_separatrix(motion)) return std::nullopt;
    const RadialClock<Potential> clock(motion, mass);
    const bool centre_is_regular = l == 0 && isfinite(potential.value(L(0)));
    if (!centre_is_regular && detail::meets_centre(motion, clock, t)) return std::nullopt;
    now = detail::after(motion, clock, t);
    if (!clock.settled()) return std::nullopt;
  }
  if (!isfinite(now.r) || !isfinite(now.phase)) return std::nullopt;

  // The unit vector from the centre at the start, turned by the phase.
  const Vector<L, 2> along =
      r0 > 0 ? Vector<L, 2>{q[0] / r0, q[1] / r0}
             : Vector<L, 2>{p[0] / (mass * motion.radial_velocity()), p[1] / (mass * motion.radial_velocity())};
  const L c = cos(now.phase);
  const L s = sin(now.phase);
  const Vector<L, 2> outward{now.side * (along[0] * c - along[1] * s), now.side * (along[0] * s + along[1] * c)};
  const L radial = mass * now.radial_velocity;
  const L around = l == 0 ? L(0) : l / now.r;
  return Start<L, 2>{{now.r * outward[0], now.r * outward[1]},
                     {radial * outward[0] - around * outward[1], radial * outward[1] + around * outward[0]}};
}

}  // namespace hamflow
