// Gauss collocation of two stages.
#pragma once

#include "hamflow/methods/gauss_two.hpp"
#include "hamflow/run/method_family.hpp"
#include "newton_family.hpp"

namespace hamflow::families {

struct GaussTwo {
  static const BoundOptions<NewtonOptions>& options() {
    static const BoundOptions<NewtonOptions> all{bind_number({.name = tolerance_option,
                                                              .meaning = "on the 2-norm of the residual of the stages",
                                                              .range = Range::positive,
                                                              .unset = "its rounding level",
                                                              .example = "1e-13"},
                                                             &NewtonOptions::tolerance),
                                                 max_iterations_option<NewtonOptions>(),
                                                 divergence_option<NewtonOptions>(),
                                                 diagnostics_option<NewtonOptions>()};
    return all;
  }

  static MethodFamily declared() {
    return {
        .name = "gauss2",
        .methods = {"gauss2"},
        .options = declarations_of(options()),
        .rank = 1,
        .not_on_lattice = "an implicit step is no bijection of the lattice; use a splitting method, e.g. stv4",
        .not_fast = "the fast kernel is for splitting methods in double",
        .describe = [](std::size_t, const Texts& given) { return describe_gauss_two(read_options(options(), given)); },
        .needs = [](std::size_t) { return "a twice differentiable H"; },
        .hint = [](const Texts&) { return "try a smaller dt, or method.on_divergence = \"halve\""; }};
  }

  template <class F>
  static auto visit(std::size_t, const Texts& given, F&& f) {
    return f(hamflow::GaussTwo{read_options(options(), given)});
  }
};

}  // namespace hamflow::families
