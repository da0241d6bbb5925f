// What a user can choose about eg, and what it then claims.
#pragma once

#include <string>

#include "hamflow/core/method_info.hpp"
#include "hamflow/methods/implicit/newton_options.hpp"

namespace hamflow {

struct EgOptions : NewtonOptions {
  int degree = 1;  // 1 to 3
};
inline constexpr int largest_eg_degree = 3;

inline MethodInfo describe(const EgOptions& options) {
  return {.name = "eg(" + std::to_string(options.degree) + ")",
          .summary = "enhanced Galerkin element in time: keeps energy, linear and angular momentum",
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
