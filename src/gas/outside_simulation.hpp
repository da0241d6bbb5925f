// A gas that reports which particle was on or beyond its soft wall, at any stage of a step.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "hamflow/run/simulation.hpp"

namespace hamflow {

/// Takes the step that a lattice refused, and a few more, in double from the last state. @return which particle was
/// outside; empty if none
using StepInDouble = std::function<std::string(const Frame& from, bool backwards)>;

std::unique_ptr<Simulation> telling_who_is_outside(std::unique_ptr<Simulation> simulation, StepInDouble in_double = {});

}  // namespace hamflow
