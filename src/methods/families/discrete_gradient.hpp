// The midpoint discrete gradient.
#pragma once

#include <any>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/gonzalez.hpp"
#include "methods/newton_family.hpp"

namespace hamflow::families {

struct DiscreteGradient {
  static const BoundOptions<NewtonOptions>& options() {
    static const BoundOptions<NewtonOptions> all = [] {
      BoundOptions<NewtonOptions> list;
      add_newton_options(list);
      return list;
    }();
    return all;
  }

  static MethodFamily declared() {
    return {
        .name = "discrete-gradient",
        .meaning = "the midpoint discrete gradient of Gonzalez: conserves any H, order 2",
        .methods = {"discrete-gradient"},
        .options = declarations_of(options()),
        .read = [](const Texts& given) { return std::any(read(given)); },
        .rank = 2,
        .not_on_lattice = "an implicit step is not a bijection of the lattice",
        .describe = [](std::size_t, const Texts& given) { return hamflow::DiscreteGradient{read(given)}.info(); },
        .needs =
            [](std::size_t) {
              return "a twice differentiable H without explicit t, as a formula that can be recorded";
            },
        .advice =
            [](std::size_t) {
              return MethodAdvice{
                  .take = "the energy must be exact, and H varies so much along a step that cg(1) needs many points",
                  .avoid =
                      "a higher order is needed: cg(2), cg(3); many cheap steps are enough for H = T(p) + V(q): "
                      "verlet"};
            },
        .refused = [](const Texts& given) { return refused_together(options(), given); },
        .hint = [](const Texts& given, const UsableAdvice& usable) { return divergence_hint(read(given), usable); }};
  }

  template <class F>
  static auto visit(std::size_t, const std::any& given, F&& f) {
    return f(hamflow::DiscreteGradient{std::any_cast<const NewtonOptions&>(given)});
  }

 private:
  static NewtonOptions read(const Texts& given) { return read_newton(options(), given); }
};

}  // namespace hamflow::families
