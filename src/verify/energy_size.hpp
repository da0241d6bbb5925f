// How large an energy is: of what its error is a part, and what moves it by rounding.
#pragma once

#include "hamflow/verify/certificate.hpp"

namespace hamflow {

/// The state of a run at its start and at its end. Empty of large systems, whose energy takes long to evaluate.
struct RunEnds {
  Frame start, end;
};
RunEnds ends_of(const Request& request, const Simulation& simulation);

/// What the forces make of an energy, the virial, is many times an energy of high powers of r: a sixteenth counts.
constexpr double virial_per_size = 16;

/// The size of the energy: its scale, but where T and V cancel or are 0 at the start (a pendulum held level) what the
/// forces there make of it.
double size_of_energy(const Request& request, const ProblemEntry& problem, const RunEnds& ends, double scale);

/// By how much one rounding of the state moves the energy, in units of rounding: sum |q_i dH/dq_i| + |p_i dH/dp_i|, a
/// quarter of it, since a rounding is a quarter of a unit in the mean. Far from the origin it is many times the energy.
/// @param dt of the run: dH/dq_i is a difference of H over a small part of what q_i moves in a step
double rounding_of_state(const Request& request, const ProblemEntry& problem, const RunEnds& ends, double dt);

/// How much more that is at the end of a run, with coordinates that keep growing, such as the angle of a rotor.
/// @param growing their numbers
double rounding_of_growing(const Request& request, const ProblemEntry& problem, const RunEnds& ends,
                           const std::vector<std::size_t>& growing, double dt);

/// By how much the units of a lattice move the energy; 0 in other arithmetic.
double energy_of_units(const Request& request, const ProblemEntry& problem, const RunEnds& ends);

}  // namespace hamflow
