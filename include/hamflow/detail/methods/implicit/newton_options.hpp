// Options of Newton's iteration for all implicit methods. newton.hpp implements the iteration.
#pragma once

#include <optional>
#include <string>

#include "hamflow/detail/numerics/newton_progress.hpp"

namespace hamflow {

/// How the equations of a step are solved.
enum class Iteration {
  newton,                // exact Jacobian in every iteration
  simplified,            // the Jacobian at the initial guess, factored once per step
  fixed_point,           // no Jacobian, only first derivatives
  fixed_point_or_newton  // fixed_point, and newton for a step that does not converge with it
};
/// The iteration that is tried first.
constexpr Iteration first_iteration(Iteration iteration) {
  return iteration == Iteration::fixed_point_or_newton ? Iteration::fixed_point : iteration;
}
constexpr Convergence convergence_of(Iteration iteration) {
  return iteration == Iteration::newton ? Convergence::quadratic : Convergence::linear;
}
/// The name of the iteration as subject of a sentence.
inline std::string solver_name(Iteration iteration) {
  return iteration == Iteration::fixed_point ? "the fixed-point iteration" : "Newton";
}

struct NewtonOptions {
  std::optional<double> tolerance{};  // on the norm of the residual; unset: its rounding level
  bool seed_criterion = false;  // stagnation above the tolerance is an error, as in the programs of the first thesis
  int max_iterations = 15;      // of each attempt
  bool halve = false;           // replace a step that does not converge by two half steps
  bool diagnostics = false;     // condition and determinant of the tangent, condition of M^-1, at every step
  Iteration iteration = Iteration::newton;
};

}  // namespace hamflow
