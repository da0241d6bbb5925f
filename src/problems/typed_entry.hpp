// The part of a catalogue entry that depends on the types of methods.
#pragma once

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// See ProblemEntry.
struct TypedEntry {
  std::function<bool(const MethodSpec&)> accepts;
  std::function<std::unique_ptr<Simulation>(const Request&)> simulate;
  bool has_pairwise_forces;
};

}  // namespace hamflow
