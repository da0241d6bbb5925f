// The discrete gradient of coordinate increments.
#pragma once

#include <any>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/itoh_abe.hpp"
#include "methods/newton_family.hpp"

namespace hamflow::families {

struct ItohAbe {
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
        .name = "itoh-abe",
        .meaning =
            "the coordinate increments of Itoh and Abe: conserves any H, uses only values of H (and derivatives to "
            "solve), order 1",
        .methods = {"itoh-abe"},
        .options = declarations_of(options()),
        .read = [](const Texts& given) { return std::any(read(given)); },
        .rank = 2,
        .not_on_lattice = "an implicit step is not a bijection of the lattice",
        .describe = [](std::size_t, const Texts& given) { return hamflow::ItohAbe{read(given)}.info(); },
        .needs = [](std::size_t) { return "a twice differentiable H as a formula that can be recorded"; },
        .advice =
            [](std::size_t) {
              return MethodAdvice{
                  .take = "you want to compare with an energy-conserving map that uses only values of H",
                  .avoid = "the solution must be accurate or reversible: cg, symmetric and of order 2 or more"};
            },
        .refused = [](const Texts& given) { return refused_together(options(), given); },
        .hint = [](const Texts& given, const UsableAdvice& usable) { return divergence_hint(read(given), usable); }};
  }

  template <class F>
  static auto visit(std::size_t, const std::any& given, F&& f) {
    return f(hamflow::ItohAbe{std::any_cast<const NewtonOptions&>(given)});
  }

 private:
  static NewtonOptions read(const Texts& given) { return read_newton(options(), given); }
};

}  // namespace hamflow::families
