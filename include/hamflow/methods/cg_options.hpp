// What a user can choose about cg, and what it then claims.
#pragma once

#include <optional>
#include <string>

#include "hamflow/core/method_info.hpp"

namespace hamflow {

struct CgOptions {
  int degree = 1;
  int quadrature = 0;                 // Gauss points; 0: "auto", the fewest that keep the energy at rounding level
  std::optional<double> tolerance{};  // on the 2-norm of the residual (2.63); unset: its rounding level
  bool seed_criterion = false;        // stagnation above the tolerance is an error, as in the programs of Gross1999
  int max_iterations = 15;
  bool halve = false;        // replace a step that does not converge by two half steps
  bool diagnostics = false;  // condition and determinant of the tangent, condition of M^-1, at every step
};

inline MethodInfo describe(const CgOptions& options) {
  const bool automatic = options.quadrature == 0;
  const bool midpoint = options.quadrature == 1;
  return {.name = "cg(" + std::to_string(options.degree) + "," +
                  (automatic ? "auto" : std::to_string(options.quadrature)) + ")",
          .summary = midpoint ? "Petrov-Galerkin element in time with one Gauss point: the implicit midpoint rule"
                              : "energy-conserving Petrov-Galerkin finite element in time",
          .reference = "Gross1999, (1.43), (1.44), (2.61)-(2.64)",
          .order = 2 * options.degree,
          .explicit_step = false,
          .symplectic = midpoint,
          .weakly_reversible = true,
          .symmetric = true,
          .reversible = true,
          .energy_conserving = automatic  ? Conservation::yes
                               : midpoint ? Conservation::no
                                          : Conservation::up_to_quadrature,
          .halves_steps = options.halve,
          .diagnostics = options.diagnostics};
}

}  // namespace hamflow
