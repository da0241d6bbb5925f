// How a step, a block of steps or a whole run ended. Numerical trouble is a value, never an exception in a loop.
#pragma once

#include <string_view>

namespace hamflow {

enum class [[nodiscard]] Outcome{
    done,             // every requested step was taken
    stopped,          // an observer requested a stop, at a step boundary
    not_converged,    // an implicit step found no solution; the state is that before the step
    non_finite,       // energy or state became infinite or NaN; the state is the last finite one
    lattice_overflow  // the lattice lost its range; the state is the last one inside
};

/// The name used in `error.kind` of a summary.
constexpr std::string_view name(Outcome outcome) {
  switch (outcome) {
    case Outcome::done:
      return "done";
    case Outcome::stopped:
      return "stopped";
    case Outcome::not_converged:
      return "not_converged";
    case Outcome::non_finite:
      return "non_finite";
    case Outcome::lattice_overflow:
      return "lattice_overflow";
  }
  return "unknown";
}

}  // namespace hamflow
