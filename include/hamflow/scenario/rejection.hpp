// A scenario that is accepted, or an exception.
#pragma once

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// The scenario that was read.   @throws Rejection when something is wrong with it
Scenario accepted(Reading reading);

}  // namespace hamflow
