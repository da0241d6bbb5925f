// Large systems never build Newton's matrix, whatever the method.
#pragma once

#include "hamflow/core/error.hpp"
#include "hamflow/methods/averages.hpp"

namespace hamflow {

/// The options of a method for steps of so many unknowns: above most_dense_unknowns fixed-point iteration.
/// @throws Error with diagnostics, which are those of a tangent
template <class Options>
Options for_unknowns(std::size_t unknowns, Options chosen) {
  if (unknowns <= most_dense_unknowns) return chosen;
  if (chosen.diagnostics) {
    throw Error("systems of more than " + std::to_string(most_dense_unknowns) +
                " unknowns are solved without a tangent, of which diagnostics are");
  }
  if (chosen.iteration == Iteration::newton && chosen.max_iterations == Options{}.max_iterations) {
    chosen.max_iterations = linear_iterations;
  }
  chosen.iteration = Iteration::fixed_point;
  return chosen;
}

}  // namespace hamflow
