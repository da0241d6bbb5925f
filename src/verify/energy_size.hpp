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

/// By how much the units of a lattice move the energy; 0 in other arithmetic.
double energy_of_units(const Request& request, const ProblemEntry& problem, const RunEnds& ends);

}  // namespace hamflow
