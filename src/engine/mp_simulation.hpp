// A simulation in Mp: every call computes with the digits of its run, on whatever thread it comes.
#pragma once

#include <memory>

#include "hamflow/run/simulation.hpp"

namespace hamflow {

std::unique_ptr<Simulation> with_digits(int digits, std::unique_ptr<Simulation> simulation);

}  // namespace hamflow
