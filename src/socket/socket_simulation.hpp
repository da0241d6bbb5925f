// A simulation whose forces come from a client: if the client fails within a step, the state before the step is kept.
#pragma once

#include <memory>

#include "hamflow/run/simulation.hpp"
#include "socket_problem.hpp"

namespace hamflow {

/// @param client of the functions of the simulation
std::unique_ptr<Simulation> keeping_good_states(std::unique_ptr<Simulation> simulation,
                                                std::shared_ptr<ClientForces> client);

}  // namespace hamflow
