// The table of a splitting method by name, for those who run its actions in a way of their own: lanes, tangent vectors.
#pragma once

#include <optional>
#include <string>

#include "hamflow/methods/splitting.hpp"

namespace hamflow {

/// None where the method is no splitting with kicks and drifts alone. @throws Error when there is no such method
std::optional<AnySplitting> splitting_named(const std::string& name);

}  // namespace hamflow
