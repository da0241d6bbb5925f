// Size of an energy: the size with which its error is compared, and the change of the energy that a rounding of the
// state causes.
#pragma once

#include "hamflow/verify/certificate.hpp"

namespace hamflow {

/// State of a run at its start and at its end. Both are empty for large systems, whose energy takes long to evaluate.
struct RunEnds {
  Frame start, end;
};
RunEnds ends_of(const Request& request, const Simulation& simulation);

/// The virial is many times the energy if V is a high power of r. Therefore it is divided by 16.
constexpr double virial_per_size = 16;

/// Returns the size of the energy: its scale, or the size that follows from the forces at the start, if T and V cancel
/// or are 0 there (a pendulum held level).
double size_of_energy(const Request& request, const ProblemEntry& problem, const RunEnds& ends, double scale);

/// Returns the change of the energy that rounding the state causes, in units of rounding: a quarter of sum |q_i
/// dH/dq_i| + |p_i dH/dp_i|, because a rounding is a quarter of a unit on average. Far from the origin it is many times
/// the energy.
/// @param dt step size of the run: dH/dq_i is a difference of H over a small part of the way that q_i moves in a step
double rounding_of_state(const Request& request, const ProblemEntry& problem, const RunEnds& ends, double dt);

/// Returns by how much that change is larger at the end of a run, because of coordinates that keep growing, such as the
/// angle of a rotor.
/// @param growing indices of these coordinates
double rounding_of_growing(const Request& request, const ProblemEntry& problem, const RunEnds& ends,
                           const std::vector<std::size_t>& growing, double dt);

/// Returns the change of the energy that one grid spacing of the lattice causes; 0 in other arithmetics.
double energy_of_units(const Request& request, const ProblemEntry& problem, const RunEnds& ends);

}  // namespace hamflow
