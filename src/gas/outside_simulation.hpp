// A gas whose soft wall tells which particle stood on it or beyond it, at any stage of a step.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "hamflow/run/simulation.hpp"

namespace hamflow {

/// Takes the step that a lattice refused, and some more, in double from its last state. @return who was outside; empty:
/// nobody
using StepInDouble = std::function<std::string(const Frame& from, bool backwards)>;

std::unique_ptr<Simulation> telling_who_is_outside(std::unique_ptr<Simulation> simulation, StepInDouble in_double = {});

}  // namespace hamflow
