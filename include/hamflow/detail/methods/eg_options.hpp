// Options and claims of eg.
#pragma once

#include <optional>
#include <string>

#include "hamflow/core/method_info.hpp"
#include "hamflow/detail/methods/implicit/newton_options.hpp"

namespace hamflow {

struct EgOptions {
  int degree = 1;                     // 1 to 3
  std::optional<double> tolerance{};  // on the 2-norm of the residual; unset: its rounding level
  bool seed_criterion = false;        // stagnation above the tolerance is an error
  int max_iterations = 15;
  bool halve = false;  // replace a step that does not converge by two half steps
  bool diagnostics = false;
  Iteration iteration = Iteration::newton;

  NewtonOptions newton() const { return {tolerance, seed_criterion, max_iterations, halve, diagnostics, iteration}; }
};
inline constexpr int largest_eg_degree = 3;

inline MethodInfo describe(const EgOptions& options) {
  return {.name = "eg(" + std::to_string(options.degree) + ")",
          .summary = "enhanced Galerkin element in time: conserves energy, linear and angular momentum",
          .reference = "GrossBetschSteinmann2005; HLW2006, Sect. II.1.3",
          .order = 2 * options.degree,
          .explicit_step = false,
          .weakly_reversible = true,
          .symmetric = true,
          .reversible = true,
          .energy_conserving = Conservation::yes,
          .halves_steps = options.halve,
          .diagnostics = options.diagnostics};
}

}  // namespace hamflow
