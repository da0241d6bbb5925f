// The averaged vector field method: another name of cg(1, quadrature).
#pragma once

#include <any>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/averages.hpp"
#include "hamflow/methods/cg.hpp"
#include "methods/newton_family.hpp"

namespace hamflow::families {

struct Avf {
  static const BoundOptions<CgOptions>& options() {
    static const BoundOptions<CgOptions> all = [] {
      BoundOptions<CgOptions> list{quadrature_option<CgOptions>(1)};
      add_newton_options(list);
      return list;
    }();
    return all;
  }

  static MethodFamily declared() {
    return {
        .name = "avf",
        .meaning = "the averaged vector field method, which is cg(1, quadrature)",
        .methods = {"avf"},
        .options = declarations_of(options()),
        .read = [](const Texts& given) { return std::any(read(given)); },
        .rank = 2,
        .not_on_lattice = "an implicit step is not a bijection of the lattice",
        .representatives = {"avf(1)", "avf(4)", "avf(auto)"},
        .describe = [](std::size_t, const Texts& given) { return hamflow::describe(read(given)); },
        .needs = [](std::size_t) { return "a twice differentiable H"; },
        .advice =
            [](std::size_t) {
              return MethodAdvice{
                  .take = "you look for the averaged vector field method by its name",
                  .avoid = "a higher order is needed: cg(2), cg(3); many cheap steps are enough: verlet"};
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
    chosen.called = ElementName::avf;
    return chosen;
  }
};

}  // namespace hamflow::families
