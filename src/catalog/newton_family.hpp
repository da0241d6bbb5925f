// What the families share whose steps are solved by Newton. The members are those of NewtonOptions.
#pragma once

#include "hamflow/core/option_info.hpp"

namespace hamflow::families {

template <class Options>
BoundOption<Options> max_iterations_option() {
  return bind_number({.name = "max_iterations",
                      .default_value = "15",
                      .meaning = "Newton corrections a step may take",
                      .range = Range::whole_from(1, 1000)},
                     &Options::max_iterations);
}

template <class Options>
BoundOption<Options> divergence_option() {
  return bind_word({.name = "on_divergence",
                    .default_value = "error",
                    .meaning = "halve: two half steps in place of one that does not converge"},
                   &Options::halve, {{"error", false}, {"halve", true}});
}

template <class Options>
BoundOption<Options> diagnostics_option() {
  return bind_yes_no({.name = "diagnostics",
                      .default_value = "false",
                      .meaning = "condition and determinant of the tangent, condition of M^-1, at every step"},
                     &Options::diagnostics);
}

}  // namespace hamflow::families
