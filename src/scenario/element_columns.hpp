// The orbital elements that are recorded of bodies: which bodies have them, and their values in a state.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hamflow/orbits/element_table.hpp"
#include "hamflow/run/simulation.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// "Jupiter", or "body2" where bodies have no names.
std::string body_name(const Scenario& scenario, std::size_t body);

/// The bodies with elements, by index.
std::vector<std::size_t> bodies_with_elements(const Scenario& scenario);

/// The elements of bodies in a state; nothing for those without.
std::vector<std::optional<OrbitalElements<double>>> elements_at(const Scenario& scenario, const Frame& frame);

}  // namespace hamflow
