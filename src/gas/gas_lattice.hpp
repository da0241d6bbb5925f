// The gas on the lattice, with kicks rounded pair by pair, on any number of threads.
#pragma once

#include "gas_functions.hpp"

namespace hamflow {

/// Null if the method is not a splitting: it then runs behind virtual calls, and each force is rounded as a whole.
std::unique_ptr<Simulation> simulate_gas_on_lattice(const Gas<double>& gas, const Vector<double, dynamic>& q,
                                                    const Vector<double, dynamic>& p, double h, const Request& request);

}  // namespace hamflow
