// Steps of a simulation that are taken in two ways: quickly by programs where they can be, else ordinarily.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "hamflow/core/outcome.hpp"

namespace hamflow {

/// Takes steps quickly as long as that goes. What stops it is taken ordinarily: one step at first, twice as many each
/// time that hardly any followed quickly, since to begin anew costs about a step.
/// @param quickly (steps) -> how many it took; nothing where all that are left have to be taken ordinarily
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
