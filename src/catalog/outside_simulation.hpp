// A gas whose soft wall tells which particle stood on it or beyond it, at any stage of a step.
#pragma once

#include <memory>

#include "hamflow/run/simulation.hpp"

namespace hamflow {

std::unique_ptr<Simulation> telling_who_is_outside(std::unique_ptr<Simulation> simulation);

}  // namespace hamflow
