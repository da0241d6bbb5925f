// What a user can choose about the Newton iteration of an implicit step, whatever the method. How it is solved is in
// newton.hpp.
#pragma once

#include <optional>
#include <string>

#include "hamflow/detail/numerics/newton_progress.hpp"

namespace hamflow {

/// How the equations of a step are solved.
enum class Iteration {
  newton,                // exact tangent in every iteration
  simplified,            // the tangent of the first guess, factored once a step
  fixed_point,           // no tangent at all: first derivatives only
  fixed_point_or_newton  // fixed_point, and newton for a step in which that does not converge
};
/// How a step is solved first, and mostly.
constexpr Iteration first_iteration(Iteration iteration) {
  return iteration == Iteration::fixed_point_or_newton ? Iteration::fixed_point : iteration;
}
constexpr Convergence convergence_of(Iteration iteration) {
  return iteration == Iteration::newton ? Convergence::quadratic : Convergence::linear;
}
/// As the subject of a sentence.
inline std::string solver_name(Iteration iteration) {
  return iteration == Iteration::fixed_point ? "the fixed-point iteration" : "Newton";
}

struct NewtonOptions {
  std::optional<double> tolerance{};  // on the norm of the residual; unset: its rounding level
  bool seed_criterion = false;        // stagnation above the tolerance is an error, as in the first thesis' programs
  int max_iterations = 15;            // of each attempt
  bool halve = false;                 // replace a step that does not converge by two half steps
  bool diagnostics = false;           // condition and determinant of the tangent, condition of M^-1, at every step
  Iteration iteration = Iteration::newton;
};

}  // namespace hamflow
