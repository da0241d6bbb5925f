// Options and claims of Gauss collocation.
#pragma once

#include <optional>
#include <string>

#include "hamflow/core/method_info.hpp"
#include "hamflow/detail/methods/implicit/newton_options.hpp"

namespace hamflow {

struct GaussOptions {
  int stages = 2;
  std::optional<double> tolerance{};  // on the 2-norm of the residual; unset: its rounding level
  bool seed_criterion = false;        // stagnation above the tolerance is an error
  int max_iterations = 15;
  bool halve = false;  // replace a step that does not converge by two half steps
  bool diagnostics = false;
  Iteration iteration = Iteration::newton;
};

inline MethodInfo describe(const GaussOptions& options) {
  const std::string stages = std::to_string(options.stages);
  return {.name = "gauss(" + stages + ")",
          .summary = "Gauss collocation in stages, symplectic to the last bit of its coefficients: the map of cg(" +
                     stages + "," + stages + ")",
          .reference = "HLW2006, II.1.3; AntonanaMakazagaMurua2017",
          .order = 2 * options.stages,
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
