// Takes the steps of a simulation by programs if possible (quickly), otherwise by the simulation (ordinarily).
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "hamflow/core/outcome.hpp"

namespace hamflow {

/// Takes steps quickly as long as possible. When that stops, it takes one step ordinarily, and twice as many each time
/// that only few quick steps followed, because restarting costs about a step.
/// @param quickly (steps) -> number of steps taken; nullopt if all remaining steps must be taken ordinarily
/// @param ordinarily (steps) -> Outcome
template <class Quickly, class Ordinarily>
Outcome take_quickly(std::int64_t steps, Quickly&& quickly, Ordinarily&& ordinarily) {
  constexpr std::int64_t most_alone = 64;
  std::int64_t alone = 1;
  while (steps > 0) {
    const std::optional<std::int64_t> taken = quickly(steps);
    if (!taken) return ordinarily(steps);
    steps -= *taken;
    alone = *taken < alone ? std::min(2 * alone, most_alone) : 1;
    const std::int64_t now = std::min(alone, steps);
    if (now == 0) break;
    if (const Outcome outcome = ordinarily(now); outcome != Outcome::done) return outcome;
    steps -= now;
  }
  return Outcome::done;
}

}  // namespace hamflow
