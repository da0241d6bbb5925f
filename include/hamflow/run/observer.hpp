// **Observer**: asks to be woken at given steps. Writers, progress bars and user callbacks are observers. Observing
// never changes the trajectory.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>

#include "hamflow/run/simulation.hpp"

namespace hamflow {

enum class Verdict { go_on, stop };

class Observer {
 public:
  static constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();
  virtual ~Observer() = default;
  /// The next step >= `step` at which to be woken, or never.
  virtual std::int64_t next_due(std::int64_t step) const = 0;
  virtual Verdict observe(const Frame& frame) = 0;
};

/// Advances to `last_step`, waking each observer when it is due, the start included.
/// @param pulse called between blocks, several times a second; returns false to stop at the step boundary reached
Outcome run(Simulation& simulation, std::int64_t last_step, std::span<Observer* const> observers,
            const std::function<bool(std::int64_t step)>& pulse = {});

}  // namespace hamflow
