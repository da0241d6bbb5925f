// Makes a simulation from a request that is not needed afterwards.
#pragma once

#include <memory>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// make_simulation without a second copy of the start, whose texts are some 400 MB for a million particles.
std::unique_ptr<Simulation> make_simulation_of(Request request);

}  // namespace hamflow
