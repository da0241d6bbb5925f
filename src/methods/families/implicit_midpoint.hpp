// The implicit midpoint rule: another name of cg(1,1).
#pragma once

#include <any>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/averages.hpp"
#include "hamflow/methods/cg.hpp"
#include "methods/newton_family.hpp"

namespace hamflow::families {

struct ImplicitMidpoint {
  static const BoundOptions<CgOptions>& options() {
    static const BoundOptions<CgOptions> all = [] {
      BoundOptions<CgOptions> list;
      add_newton_options(list);
      return list;
    }();
    return all;
  }

  static MethodFamily declared() {
    return {
        .name = "implicit-midpoint",
        .meaning = "the implicit midpoint rule, which is gauss(1) and cg(1,1)",
        .methods = {"implicit-midpoint"},
        .options = declarations_of(options()),
        .read = [](const Texts& given) { return std::any(read(given)); },
        .rank = 2,
        .not_on_lattice = "an implicit step is not a bijection of the lattice",
        .describe = [](std::size_t, const Texts& given) { return hamflow::describe(read(given)); },
        .needs = [](std::size_t) { return "a twice differentiable H"; },
        .advice =
            [](std::size_t) {
              return MethodAdvice{
                  .take = "H is not T(p) + V(q), the map must be symplectic, and order 2 is enough",
                  .avoid = "the energy must be exact: cg; a higher order is needed: gauss; H = T(p) + V(q): verlet"};
            },
        .refused = [](const Texts& given) { return refused_together(options(), given); },
        .hint = [](const Texts& given, const UsableAdvice& usable) { return divergence_hint(read(given), usable); }};
  }

  template <class F>
  static auto visit(std::size_t, const std::any& given, F&& f) {
    const auto& chosen = std::any_cast<const CgOptions&>(given);
    if (chosen.iteration == Iteration::newton) return f(hamflow::Cg{chosen});
    return f(Averages{chosen});
  }

 private:
  static CgOptions read(const Texts& given) {
    CgOptions chosen = read_newton(options(), given);
    chosen.quadrature = 1;
    chosen.called = ElementName::implicit_midpoint;
    return chosen;
  }
};

}  // namespace hamflow::families
