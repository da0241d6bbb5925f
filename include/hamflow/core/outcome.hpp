// How a step, a block of steps, a run or a member of a sweep ended. Numerical trouble is a value, never an exception in
// a loop. Its name, what it means and what helps stand here and nowhere else.
#pragma once

#include <string>
#include <string_view>

namespace hamflow {

enum class [[nodiscard]] Outcome{
    done,              // every requested step was taken
    stopped,           // an observer requested a stop, at a step boundary
    not_converged,     // an implicit step found no solution; the state is that before the step
    non_finite,        // energy or state became infinite or NaN; the state is the last finite one
    lattice_overflow,  // the lattice lost its range; the state is the last one inside
    wall,              // more bounces in one step than can be; the state is that before the step
    outside,           // on or beyond a soft wall at some evaluation; the state is the last good one
    not_run            // a member of a sweep whose turn did not come
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

/// True for what ends a run before its time by its numbers: exit status 1.
constexpr bool is_failure(Outcome outcome) {
  return outcome != Outcome::done && outcome != Outcome::stopped && outcome != Outcome::not_run;
}

/// What happened, as a sentence without its end; empty where nothing went wrong. Of a step that did not converge the
/// simulation knows more: Simulation::failure().
constexpr std::string_view message(Outcome outcome) {
  switch (outcome) {
    case Outcome::not_converged:
      return "the step found no solution";
    case Outcome::non_finite:
      return "the energy or the state became infinite or NaN";
    case Outcome::lattice_overflow:
      return "a number left the range of the lattice";
    case Outcome::wall:
      return "the step met its walls more often than 1000 times";
    case Outcome::outside:
      return "a coordinate stood on a soft wall or beyond it";
    case Outcome::done:
    case Outcome::stopped:
    case Outcome::not_run:
      break;
  }
  return {};
}

/// The first line of Simulation::failure(): why the step failed.
inline std::string cause_of(const std::string& failure) { return failure.substr(0, failure.find('\n')); }
/// The numbers behind that line; often none.
inline std::string numbers_of(const std::string& failure) {
  const std::size_t end = failure.find('\n');
  return end == std::string::npos ? "" : failure.substr(end + 1);
}

/// What helps; empty where nothing went wrong. What depends on the method or the problem is added where they are known.
constexpr std::string_view hint(Outcome outcome) {
  switch (outcome) {
    case Outcome::not_converged:
      return "try a smaller dt";
    case Outcome::non_finite:
      return "try a smaller dt: the energy in the samples before shows where it went wrong";
    case Outcome::lattice_overflow:
      return "a position or momentum left the range of 2^62 lattice units: give larger powers of two in run.lattice";
    case Outcome::wall:
      return "try a smaller dt; a motion that is pressed onto a wall for good cannot be followed by bounces";
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
