// The table of a splitting method by name, for code that runs its actions itself: lanes, tangent vectors.
#pragma once

#include <optional>
#include <string>

#include "hamflow/methods/splitting.hpp"

namespace hamflow {

/// nullopt if the method is not a splitting of only kicks and drifts. @throws Error if there is no such method
std::optional<AnySplitting> splitting_named(const std::string& name);

}  // namespace hamflow
