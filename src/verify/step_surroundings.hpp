// Where the step of a foreign program is measured: states about a state of the motion, and the sizes and the time that
// belong to it.
#pragma once

#include <vector>

#include "hamflow/verify/certify_step.hpp"

namespace hamflow {

inline constexpr std::uint64_t state_seed = 20260711;  // any number: fixed, so that a measurement can be repeated

/// States in general position, units of q and p, and the fastest angular frequency.
struct Surroundings {
  std::vector<State<double>> states;
  State<double> unit;  // of each number of a state
  double frequency = 0;
};

/// The Euclidean norm.
double size_of(const State<double>& x);
/// The spectral radius of the vector field's Jacobian at z, in radians per unit of time; 0 where it is not finite.
double frequency_at(const StepProblem& problem, const State<double>& z);
/// @throws Error where the problem has no state to begin with, is not regular there, or does not move
Surroundings surroundings_of(const StepProblem& problem);

}  // namespace hamflow
