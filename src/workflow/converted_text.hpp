// Text of a scenario in other coordinates. Other code checks whether its method can be used in them.
#pragma once

#include "hamflow/scenario/coordinates.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// Replaces a given state by `start`. An orbit and two bodies are kept, because they mean the same in both coordinates.
std::string converted_text(const Scenario& scenario, const std::string& to, const CanonicalState& start);

}  // namespace hamflow
