// Options and claims of cg.
#pragma once

#include <optional>
#include <string>

#include "hamflow/core/method_info.hpp"
#include "hamflow/detail/methods/implicit/newton_options.hpp"

namespace hamflow {

/// Names of the same map.
enum class ElementName { cg, avf, implicit_midpoint };

struct CgOptions {
  int degree = 1;
  int quadrature = 0;                 // Gauss points; 0: "auto", the fewest that keep the energy at rounding level
  std::optional<double> tolerance{};  // on the 2-norm of the residual (2.63); unset: its rounding level
  bool seed_criterion = false;        // stagnation above the tolerance is an error, as in the programs of Gross1999
  int max_iterations = 15;
  bool halve = false;        // replace a step that does not converge by two half steps
  bool diagnostics = false;  // condition and determinant of the tangent, condition of M^-1, at every step
  Iteration iteration = Iteration::newton;
  ElementName called = ElementName::cg;
};

inline MethodInfo describe(const CgOptions& options) {
  const bool automatic = options.quadrature == 0;
  const bool collocation = options.quadrature == options.degree;
  const std::string points = automatic ? "auto" : std::to_string(options.quadrature);
  const std::string degree = std::to_string(options.degree);
  return {.name = options.called == ElementName::avf                 ? "avf(" + points + ")"
                  : options.called == ElementName::implicit_midpoint ? "implicit-midpoint"
                                                                     : "cg(" + degree + "," + points + ")",
          .summary = collocation ? "Petrov-Galerkin element in time with " +
                                       (options.degree == 1 ? "one Gauss point: the implicit midpoint rule"
                                                            : degree + " Gauss points: Gauss collocation") +
                                       ", the map of gauss(" + degree + ")"
                     : options.called == ElementName::avf
                         ? "averaged vector field method: the energy-conserving element cg(1," + points + ")"
                         : "energy-conserving Petrov-Galerkin finite element in time",
          .reference = options.degree == 1 ? "Gross1999, (1.43), (1.44), (2.61)-(2.64)"
                                           : "Gross1999, (1.34), (1.35); BrugnanoIavernaroTrigiante2010",
          .order = 2 * options.degree,
          .explicit_step = false,
          .symplectic = collocation,
          .weakly_reversible = true,
          .symmetric = true,
          .reversible = true,
          .energy_conserving = automatic     ? Conservation::yes
                               : collocation ? Conservation::no
                                             : Conservation::up_to_quadrature,
          .halves_steps = options.halve,
          .diagnostics = options.diagnostics};
}

}  // namespace hamflow
