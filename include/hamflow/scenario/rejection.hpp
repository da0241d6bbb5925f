// Turns a reading into a scenario, or throws.
#pragma once

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// Returns the scenario that was read.   @throws Rejection if it has errors
Scenario accepted(Reading reading);

}  // namespace hamflow
