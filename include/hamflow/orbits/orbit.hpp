// An orbit given by elements: a size, a shape, three angles, and a place on it. These functions convert it to position
// and velocity, or list its errors.
#pragma once

#include <optional>
#include <vector>

#include "hamflow/core/complaint.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/orbits/universal_kepler.hpp"

namespace hamflow {

/// Angles are in radians. Members have the names of the keys of a scenario.
template <class R>
struct Orbit {
  // The size: exactly one of these.
  std::optional<R> a;                    // negative on a hyperbola; not with e = 1
  std::optional<R> period;               // only for ellipses
  std::optional<R> pericentre_distance;  // every conic

  R e = R(0);
  R inclination = R(0);  // in [0, pi]
  R node = R(0);
  // At most one of these.
  std::optional<R> pericentre;               // from the node
  std::optional<R> longitude_of_pericentre;  // node + pericentre, at every inclination

  // The place: at most one of these. Default: at the pericentre.
  std::optional<R> mean_anomaly;        // hyperbola: e sinh F - F
  std::optional<R> true_anomaly;        // every conic
  std::optional<R> eccentric_anomaly;   // hyperbola: F
  std::optional<R> mean_longitude;      // longitude of the pericentre + mean anomaly
  std::optional<R> time_of_pericentre;  // every conic
};

/// Position and velocity about the primary.
template <class R>
struct OrbitState {
  Vector<R, 3> position;
  Vector<R, 3> velocity;
};

/// Returns the errors of an orbit, each with its key; empty if there are none.
std::vector<Complaint> complaints_about(const Orbit<double>& orbit);

namespace detail {

/// The motion from the pericentre, in units in which pericentre distance and mu are 1, so that beta = 1 - e.
template <class R>
UniversalStart<R> unit_pericentre(const R& e) {
  return {R(1), R(0), R(1), R(1) - e};
}

/// Returns the cube root, accurate to about the last digit.
template <class R>
R cube_root(const R& x) {
  const R guess = pow(x, R(1) / R(3));
  return guess - (guess - x / (guess * guess)) / R(3);
}

/// A state in the plane of the orbit, with x towards the pericentre, distances in units of q and velocities in units of
/// sqrt(mu/q).
template <class R>
struct PlaceOnConic {
  R x;
  R y;
  R x_rate;
  R y_rate;
};

template <class R>
PlaceOnConic<R> place_by_functions(const R& e, const UniversalFunctions<R>& g) {
  const R root = sqrt(R(1) + e);
  const R distance = R(1) + e * g.g2;
  return {R(1) - g.g2, root * g.g1, -g.g1 / distance, root * g.g0 / distance};
}

template <class R>
PlaceOnConic<R> place_by_true_anomaly(const R& e, const R& f) {
  const R half_cosine = cos(f / R(2));
  const R half_sine = sin(f / R(2));
  const R cosine = (half_cosine - half_sine) * (half_cosine + half_sine);
  const R sine = R(2) * half_sine * half_cosine;
  // 1 + e cos f, which cancels near the apocentre of a long ellipse.
  const R inverse = (R(1) + e) * half_cosine * half_cosine + (R(1) - e) * half_sine * half_sine;
  const R distance = (R(1) + e) / inverse;
  const R root = sqrt(R(1) + e);
  return {distance * cosine, distance * sine, -sine / root, (e + cosine) / root};
}

/// @returns false if Kepler's equation has no solution in R
template <class R>
bool place_by_time(const R& e, R t, PlaceOnConic<R>& place) {
  const UniversalStart<R> start = unit_pericentre(e);
  R s;
  UniversalTime<R> found;
  if (!solve_universal_kepler(start, abs(t), s, found)) return false;
  if (t < R(0)) {
    found.g.g1 = -found.g.g1;
    found.g.g3 = -found.g.g3;
  }
  place = place_by_functions(e, found.g);
  return true;
}

/// Returns an angle minus the nearest whole number of revolutions.
template <class R>
R nearest_turn_removed(const R& angle) {
  return reduced_by_period(angle, full_turn<R>());
}

}  // namespace detail

/// Returns the state of a body on an orbit with mu = G m > 0 at time `t`. complaints_about() has to be empty for it.
/// @returns nullopt if position or velocity is not finite in R
template <class R>
std::optional<OrbitState<R>> state_on(const Orbit<R>& orbit, const R& mu, const R& t = R(0)) {
  using C = typename CarefulNumber<R>::type;  // for double, avoids rounding of 1 - e, angles, Kepler's equation
  const auto careful = [](const R& x) { return C(x); };
  const C e = careful(orbit.e);
  const C gap = C(1) - e;
  const C mass = careful(mu);
  C q;
  if (orbit.pericentre_distance) {
    q = careful(*orbit.pericentre_distance);
  } else if (orbit.a) {
    q = careful(*orbit.a) * gap;
  } else {
    const C rate = detail::full_turn<C>() / careful(orbit.period.value());
    q = detail::cube_root(mass / (rate * rate)) * gap;
  }
  const C node = careful(orbit.node);
  const C pericentre = orbit.longitude_of_pericentre ? careful(*orbit.longitude_of_pericentre) - node
                                                     : careful(orbit.pericentre.value_or(R(0)));
  const C rate = sqrt(mass / q);  // velocities; times by q/rate

  detail::PlaceOnConic<C> place;
  if (orbit.true_anomaly) {
    place = detail::place_by_true_anomaly(e, careful(*orbit.true_anomaly));
  } else if (orbit.eccentric_anomaly) {
    const C anomaly = careful(*orbit.eccentric_anomaly);
    const C s = (C(0) < gap ? detail::nearest_turn_removed(anomaly) : anomaly) / sqrt(abs(gap));
    place = detail::place_by_functions(e, universal_functions(gap, s));
  } else if (orbit.time_of_pericentre) {
    C since = (careful(t) - careful(*orbit.time_of_pericentre)) * (rate / q);
    if (C(0) < gap) since = detail::reduced_by_period(since, detail::full_turn<C>() / (gap * sqrt(gap)));
    if (!detail::place_by_time(e, since, place)) return std::nullopt;
  } else {
    C mean = careful(orbit.mean_anomaly.value_or(R(0)));
    if (orbit.mean_longitude) mean = careful(*orbit.mean_longitude) - (node + pericentre);
    if (C(0) < gap) mean = detail::nearest_turn_removed(mean);
    const C since = mean == C(0) ? C(0) : mean / (abs(gap) * sqrt(abs(gap)));
    if (!detail::place_by_time(e, since, place)) return std::nullopt;
  }

  const C cos_node = cos(node);
  const C sin_node = sin(node);
  const C cos_pericentre = cos(pericentre);
  const C sin_pericentre = sin(pericentre);
  const C cos_tilt = cos(careful(orbit.inclination));
  const C sin_tilt = sin(careful(orbit.inclination));
  const C towards[3] = {cos_node * cos_pericentre - sin_node * sin_pericentre * cos_tilt,
                        sin_node * cos_pericentre + cos_node * sin_pericentre * cos_tilt, sin_pericentre * sin_tilt};
  const C across[3] = {-(cos_node * sin_pericentre) - sin_node * cos_pericentre * cos_tilt,
                       cos_node * cos_pericentre * cos_tilt - sin_node * sin_pericentre, cos_pericentre * sin_tilt};
  OrbitState<R> state;
  for (std::size_t i = 0; i < 3; ++i) {
    state.position[i] = R(q * (place.x * towards[i] + place.y * across[i]));
    state.velocity[i] = R(rate * (place.x_rate * towards[i] + place.y_rate * across[i]));
    if (!(abs(state.position[i]) + abs(state.velocity[i]) <= std::numeric_limits<R>::max())) return std::nullopt;
  }
  return state;
}

}  // namespace hamflow
