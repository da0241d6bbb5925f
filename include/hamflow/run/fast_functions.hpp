// kernel = "fast" for any problem: in all that moves the state, k/(u sqrt(u)) and k/sqrt(u) are computed by estimate
// and series (core/inverse_cube.hpp). Energies and invariants, which are watched, stay as they are. Recorded steps have
// the estimates as instructions; where a single function is called (the first step, a part of a step), it is recorded
// there and then, so that a step has the same bits by either road.
#pragma once

#include <memory>

#include "hamflow/run/any_problem.hpp"

namespace hamflow {

/// The functions of one problem, in double and for recordings.
struct FastFunctions {
  std::shared_ptr<const Functions<double>> plain;
  std::shared_ptr<const Functions<Trace<double>>> trace;
};

/// Steps of functions by estimates have to be recorded: too long a step is no kernel = "fast".
struct TooLongToEstimate : Error {
  using Error::Error;
};

/// The functions by estimates, as far as splittings, force gradients and Runge-Kutta methods use them.
FastFunctions fast_functions(std::shared_ptr<const Functions<double>> plain,
                             std::shared_ptr<const Functions<Trace<double>>> trace);

/// Whether anything is estimated among the first operations of a gradient there.
bool has_estimates(const FastFunctions& functions, const Vector<double, dynamic>& q, const Vector<double, dynamic>& p);

}  // namespace hamflow
