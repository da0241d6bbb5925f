// **Observer**: called at the steps that it requests. Writers, progress bars and user callbacks are observers.
// Observing never changes the trajectory.
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
  /// The next step >= `step` at which to be called, or never.
  virtual std::int64_t next_due(std::int64_t step) const = 0;
  virtual Verdict observe(const Frame& frame) = 0;
  /// Called when the step after the last one that was observed has failed, before the run is given up.
  /// @return stop: the run was to end within that step, and has come to its end
  virtual Verdict observe_failed_step() { return Verdict::go_on; }
  /// Where due at `step`: the times from this step on, before the next one, at which the state is wanted, as number
  /// expressions in the order of the run. observe() is called once for each, with the state that a partial step gives
  /// (Simulation::look_ahead). None: once, with the state of the step.
  virtual std::span<const std::string> times(std::int64_t /*step*/) const { return {}; }

  /// What was seen so far, for a checkpoint, and back: everything that decides what the rest of the run makes of it.
  /// One list of fields serves both directions (detail/core/archive.hpp):
  ///     void archive(Writer& ar) override { fields(ar); }
  ///     void archive(Reader& ar) override { fields(ar); }
  /// An observation that is due only because the run ends is left out, so that a longer run can go on from there. The
  /// Reader is called on a fresh observer, when the simulation stands where the run goes on.
  /// @throws Error unless overridden: an observer without it cannot be part of a run with checkpoints
  virtual void archive(Writer& /*ar*/) { refuse_archive(); }
  virtual void archive(Reader& /*ar*/) { refuse_archive(); }

 private:
  [[noreturn]] static void refuse_archive() {
    throw Error("found an observer without archive(); allowed in a run with checkpoints: observers that override both");
  }
};

/// Advances to `last_step`, calling each observer when it is due, the start included. A partial step that fails ends
/// the run like a step that fails.
/// @param pulse called between blocks, several times a second; returns false to stop at the step boundary reached
Outcome run(Simulation& simulation, std::int64_t last_step, std::span<Observer* const> observers,
            const std::function<bool(std::int64_t step)>& pulse = {});

}  // namespace hamflow
