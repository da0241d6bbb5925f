// Options and claims of lobatto-3a-3b.
#pragma once

#include <optional>
#include <string>

#include "hamflow/core/method_info.hpp"
#include "hamflow/detail/methods/implicit/newton_options.hpp"

namespace hamflow {

struct LobattoOptions {
  int stages = 2;                     // 2 to 10
  std::optional<double> tolerance{};  // on the 2-norm of the residual; unset: its rounding level
  bool seed_criterion = false;        // stagnation above the tolerance is an error
  int max_iterations = 15;
  bool halve = false;  // replace a step that does not converge by two half steps
  bool diagnostics = false;
  Iteration iteration = Iteration::newton;

  NewtonOptions newton() const { return {tolerance, seed_criterion, max_iterations, halve, diagnostics, iteration}; }
};

inline MethodInfo describe(const LobattoOptions& options) {
  return {.name = "lobatto-3a-3b(" + std::to_string(options.stages) + ")",
          .summary = "partitioned Runge-Kutta pair of Lobatto, IIIA for q and IIIB for p",
          .reference = "HLW2006, Sect. II.2.2",
          .order = 2 * options.stages - 2,
          .explicit_step = false,
          .symplectic = true,
          .weakly_reversible = true,
          .symmetric = true,
          .reversible = true,
          .energy_conserving = Conservation::no,
          .halves_steps = options.halve,
          .diagnostics = options.diagnostics};
}

}  // namespace hamflow
