// Returns an accepted scenario or throws.
#pragma once

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// The scenario that was read.   @throws Rejection if it has errors
Scenario accepted(Reading reading);

}  // namespace hamflow
