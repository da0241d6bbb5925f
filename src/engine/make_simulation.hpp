// A simulation of a request that nobody needs afterwards.
#pragma once

#include <memory>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// make_simulation, without a second copy of the start: of a million particles its texts are some 400 MB.
std::unique_ptr<Simulation> make_simulation_of(Request request);

}  // namespace hamflow
