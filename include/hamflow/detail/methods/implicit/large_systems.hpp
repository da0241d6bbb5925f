// Methods never build Newton's matrix for large systems.
#pragma once

#include "hamflow/core/error.hpp"
#include "hamflow/methods/averages.hpp"

namespace hamflow {

/// The options of a method for a step with the given number of unknowns: fixed-point iteration above
/// most_dense_unknowns.
/// @throws Error with diagnostics, which need the Jacobian
template <class Options>
Options for_unknowns(std::size_t unknowns, Options chosen) {
  if (unknowns <= most_dense_unknowns) return chosen;
  if (chosen.diagnostics) {
    throw Error("systems of more than " + std::to_string(most_dense_unknowns) +
                " unknowns are solved without a Jacobian, which diagnostics need");
  }
  if (chosen.iteration == Iteration::newton && chosen.max_iterations == Options{}.max_iterations) {
    chosen.max_iterations = linear_iterations;
  }
  chosen.iteration = Iteration::fixed_point;
  return chosen;
}

}  // namespace hamflow
