// The figure of most orbits of Gross1999: the orbit above, energy over time and effective potential over r below.
#pragma once

#include <functional>
#include <string>

#include "study.hpp"

namespace hamflow::reproduction {

/// @param V of r   @param mu the reduced mass
figures::Page orbit_page(const std::string& title, const Trajectory& dots, const Trajectory& exact,
                         const std::function<double(double)>& V, double mu);

}  // namespace hamflow::reproduction
