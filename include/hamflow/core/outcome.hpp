// The outcome of a step, a block of steps, a run or an ensemble member. A numerical failure is a value, never an
// exception in a loop. Names, messages and hints of outcomes are defined here and nowhere else.
#pragma once

#include <string>
#include <string_view>

namespace hamflow {

enum class [[nodiscard]] Outcome{
    done,              // every requested step was taken
    stopped,           // an observer requested a stop, at a step boundary
    not_converged,     // an implicit step did not converge; the state is the one before the step
    non_finite,        // energy or state became infinite or NaN; the state is the last finite one
    lattice_overflow,  // a number left the range of the lattice; the state is the last one inside
    wall,              // too many bounces in one step; the state is the one before the step
    outside,           // an evaluation on or beyond a soft wall; the state is the last valid one
    not_run            // a member of a sweep that was not started
};

/// The name used in the status of a sweep's members and in `error.kind` of a summary.
constexpr std::string_view name(Outcome outcome) {
  switch (outcome) {
    case Outcome::done:
      return "done";
    case Outcome::stopped:
      return "interrupted";
    case Outcome::not_converged:
      return "not_converged";
    case Outcome::non_finite:
      return "non_finite";
    case Outcome::lattice_overflow:
      return "lattice_overflow";
    case Outcome::wall:
      return "wall";
    case Outcome::outside:
      return "outside";
    case Outcome::not_run:
      return "not_run";
  }
  return "unknown";
}

/// Whether a numerical failure ended the run early: exit status 1.
constexpr bool is_failure(Outcome outcome) {
  return outcome != Outcome::done && outcome != Outcome::stopped && outcome != Outcome::not_run;
}

/// The failure as a sentence without a full stop; empty if there is none. Simulation::failure() says more about a step
/// that did not converge.
constexpr std::string_view message(Outcome outcome) {
  switch (outcome) {
    case Outcome::not_converged:
      return "the step did not converge";
    case Outcome::non_finite:
      return "the energy or the state became infinite or NaN";
    case Outcome::lattice_overflow:
      return "a number left the range of the lattice";
    case Outcome::wall:
      return "the step hit its walls more than 1000 times";
    case Outcome::outside:
      return "a coordinate was on or beyond a soft wall";
    case Outcome::done:
    case Outcome::stopped:
    case Outcome::not_run:
      break;
  }
  return {};
}

/// The first line of Simulation::failure(): why the step failed.
inline std::string cause_of(const std::string& failure) { return failure.substr(0, failure.find('\n')); }
/// The numbers after that line; may be empty.
inline std::string numbers_of(const std::string& failure) {
  const std::size_t end = failure.find('\n');
  return end == std::string::npos ? "" : failure.substr(end + 1);
}

/// Advice; empty if nothing went wrong. Callers that know the method and the problem add to it.
constexpr std::string_view hint(Outcome outcome) {
  switch (outcome) {
    case Outcome::not_converged:
      return "try a smaller dt";
    case Outcome::non_finite:
      return "try a smaller dt; the energies of the last samples show where the error began";
    case Outcome::lattice_overflow:
      return "a position or momentum left the range of 2^62 grid spacings: set larger powers of two in run.lattice";
    case Outcome::wall:
      return "try a smaller dt; a motion that stays pressed onto a wall cannot be resolved into bounces";
    case Outcome::outside:
      return "try a smaller dt, or a larger exponent";
    case Outcome::done:
    case Outcome::stopped:
    case Outcome::not_run:
      break;
  }
  return {};
}

}  // namespace hamflow
