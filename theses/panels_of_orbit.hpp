// The page for orbits of Gross1999: above the orbit, below the energy over time and the effective potential over r.
#pragma once

#include <functional>
#include <string>

#include "study.hpp"

namespace hamflow::reproduction {

/// @param dots the run   @param exact the reference solution, drawn as a line
/// @param V the potential as a function of r   @param mu the reduced mass
figures::Page orbit_page(const std::string& title, const Trajectory& dots, const Trajectory& exact,
                         const std::function<double(double)>& V, double mu);

}  // namespace hamflow::reproduction
