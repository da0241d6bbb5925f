// **Observer**: an object that is called at the steps that it requests, such as a writer, a progress bar or a user
// callback. Observers never change the trajectory.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>

#include "hamflow/detail/core/archive.hpp"
#include "hamflow/run/simulation.hpp"

namespace hamflow {

enum class Verdict { go_on, stop };

class Observer {
 public:
  static constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();
  virtual ~Observer() = default;
  /// The next step >= `step` at which it wants to be called, or `never`.
  virtual std::int64_t next_due(std::int64_t step) const = 0;
  virtual Verdict observe(const Frame& frame) = 0;
  /// Called if the step after the last observed one has failed, before the run ends.
  /// @return stop if the run was to end within that step and has reached its end
  virtual Verdict observe_failed_step() { return Verdict::go_on; }
  /// If due at `step`: the times between this step and the next at which the state is needed, as number expressions in
  /// the order of the run. observe() is called once for each time, with the state after a partial step
  /// (Simulation::look_ahead). If there are none, it is called once, with the state of the step.
  virtual std::span<const std::string> times(std::int64_t /*step*/) const { return {}; }

  /// Saves and restores the observer's state for a checkpoint: everything that affects its results in the rest of the
  /// run. One list of fields serves both directions (detail/core/archive.hpp):
  ///     void archive(Writer& ar) override { fields(ar); }
  ///     void archive(Reader& ar) override { fields(ar); }
  /// An observation that is due only because the run ends is left out, so that a longer run can continue. The Reader is
  /// called on a new observer, when the simulation is in the state where the run continues.
  /// @throws Error unless overridden: a run with checkpoints needs it of every observer
  virtual void archive(Writer& /*ar*/) { refuse_archive(); }
  virtual void archive(Reader& /*ar*/) { refuse_archive(); }

 private:
  [[noreturn]] static void refuse_archive() {
    throw Error(
        "found an observer without archive(); a run with checkpoints needs observers that override both functions");
  }
};

/// Advances to `last_step` and calls each observer when it is due, including at the start. A partial step that fails
/// ends the run like a step that fails.
/// @param pulse called between blocks, several times a second; returns false to stop at the step boundary reached
Outcome run(Simulation& simulation, std::int64_t last_step, std::span<Observer* const> observers,
            const std::function<bool(std::int64_t step)>& pulse = {});

}  // namespace hamflow
