// The text of a scenario in other coordinates, before anybody asks whether its method can be used in them.
#pragma once

#include "hamflow/scenario/coordinates.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// An orbit or two bodies mean the same in both coordinates; a state is replaced by `start`.
std::string converted_text(const Scenario& scenario, const std::string& to, const CanonicalState& start);

}  // namespace hamflow
