// States at which the step of a foreign program is measured, near a state of the motion, with their sizes and time
// scale.
#pragma once

#include <vector>

#include "hamflow/verify/certify_step.hpp"

namespace hamflow {

inline constexpr std::uint64_t state_seed = 20260711;  // arbitrary but fixed, so that a measurement can be repeated

/// States in general position, units of q and p, and the fastest angular frequency.
struct StepTestStates {
  std::vector<State<double>> states;
  State<double> unit;  // unit of each number of a state
  double frequency = 0;
};

/// Euclidean norm.
double size_of(const State<double>& x);
/// Returns the spectral radius of the vector field's Jacobian at z, in radians per unit of time; 0 if it is not finite.
double frequency_at(const StepProblem& problem, const State<double>& z);
/// @throws Error if the problem has no start, is singular there, or does not move
StepTestStates step_test_states(const StepProblem& problem);

}  // namespace hamflow
