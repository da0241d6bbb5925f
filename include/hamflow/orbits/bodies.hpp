// The start of a system of bodies, each given by an orbit about other bodies or by position and velocity.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "hamflow/orbits/elements.hpp"
#include "hamflow/orbits/orbit.hpp"

namespace hamflow {

/// What an orbit is about.
enum class Primary {
  jacobi,     // the centre of mass of the bodies before; mu = G (their mass + the mass of the body)
  body,       // one body before; mu = G (its mass + the mass of the body)
  barycentre  // the centre of mass of all; mu = G (the mass of all)
};

template <class R>
struct BodyStart {
  R mass = R(0);                    // 0: the body is felt by none
  std::optional<Orbit<R>> orbit{};  // nothing: the body is at `state`
  OrbitState<R> state{};
  Primary primary = Primary::jacobi;
  std::size_t of = 0;  // the index of the primary, for Primary::body
};

template <class R>
struct BodyStates {
  std::vector<OrbitState<R>> states{};
  std::optional<std::size_t> not_finite{};  // a body whose position or velocity is not finite in R
};

/// Positions and velocities at `t`. With Primary::barycentre every massive body but the first has to have it; the first
/// is then placed so that the centre of mass is at rest at the origin.
template <class R>
BodyStates<R> states_of(const std::vector<BodyStart<R>>& bodies, const R& gravitational_constant, const R& t = R(0)) {
  BodyStates<R> out;
  out.states.resize(bodies.size());
  R total(0);
  for (const BodyStart<R>& body : bodies) total += body.mass;
  bool is_barycentric = false;
  for (const BodyStart<R>& body : bodies) {
    is_barycentric = is_barycentric || (R(0) < body.mass && body.orbit && body.primary == Primary::barycentre);
  }
  const auto add = [](OrbitState<R>& to, const R& factor, const OrbitState<R>& state) {
    for (std::size_t k = 0; k < 3; ++k) {
      to.position[k] += factor * state.position[k];
      to.velocity[k] += factor * state.velocity[k];
    }
  };
  const auto place = [&](std::size_t i) {
    const BodyStart<R>& body = bodies[i];
    out.states[i] = body.state;
    if (!body.orbit) return;
    R mass(0);
    OrbitState<R> centre{};
    if (body.primary == Primary::barycentre) {
      mass = total;
      for (std::size_t j = 0; j < bodies.size() && !is_barycentric; ++j) {
        add(centre, bodies[j].mass / total, out.states[j]);
      }
    } else if (body.primary == Primary::body) {
      mass = bodies[body.of].mass + body.mass;
      centre = out.states[body.of];
    } else {
      for (std::size_t j = 0; j < i; ++j) mass += bodies[j].mass;
      for (std::size_t j = 0; j < i; ++j) add(centre, bodies[j].mass / mass, out.states[j]);
      mass += body.mass;
    }
    const auto state = state_on(*body.orbit, R(gravitational_constant * mass), t);
    if (!state) {
      if (!out.not_finite) out.not_finite = i;
      return;
    }
    out.states[i] = *state;
    add(out.states[i], R(1), centre);
  };
  // Massive bodies first: massless ones may be about the centre of mass of all.
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (R(0) < bodies[i].mass && !(is_barycentric && i == 0)) place(i);
  }
  if (is_barycentric) {
    for (std::size_t i = 1; i < bodies.size(); ++i) {
      if (R(0) < bodies[i].mass) add(out.states[0], -(bodies[i].mass / bodies[0].mass), out.states[i]);
    }
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!(R(0) < bodies[i].mass)) place(i);
  }
  return out;
}

/// The elements of each body about its primary, with mu as for Primary. Nothing for the first body, for the body that
/// is the primary of all others, and for bodies before the first with a mass.
template <class R>
std::vector<std::optional<OrbitalElements<R>>> elements_of_bodies(const std::vector<R>& masses,
                                                                  const std::vector<OrbitState<R>>& states,
                                                                  const R& gravitational_constant, Primary primary,
                                                                  std::size_t of = 0) {
  R mass(0);
  OrbitState<R> centre{};  // of the bodies before, of all, or of the primary
  const auto add = [&](std::size_t j) {
    if (!(R(0) < masses[j])) return;
    mass += masses[j];
    for (std::size_t k = 0; k < 3; ++k) {
      centre.position[k] += masses[j] / mass * (states[j].position[k] - centre.position[k]);
      centre.velocity[k] += masses[j] / mass * (states[j].velocity[k] - centre.velocity[k]);
    }
  };
  if (primary == Primary::body) add(of);
  for (std::size_t j = 0; primary == Primary::barycentre && j < masses.size(); ++j) add(j);
  std::vector<std::optional<OrbitalElements<R>>> all(masses.size());
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const bool is_about_all = primary == Primary::barycentre;
    const bool has_orbit = primary == Primary::body ? i != of : i > 0;
    if (has_orbit && R(0) < mass) {
      Vector<R, 3> r;
      Vector<R, 3> v;
      for (std::size_t k = 0; k < 3; ++k) {
        r[k] = states[i].position[k] - centre.position[k];
        v[k] = states[i].velocity[k] - centre.velocity[k];
      }
      all[i] = elements_of(r, v, R(gravitational_constant * (is_about_all ? mass : mass + masses[i])));
    }
    if (primary == Primary::jacobi) add(i);
  }
  return all;
}

}  // namespace hamflow
