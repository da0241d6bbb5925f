// Gauss collocation, in stages.
#pragma once

#include <any>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/averages.hpp"
#include "methods/newton_family.hpp"

namespace hamflow::families {

struct Gauss {
  static const BoundOptions<GaussOptions>& options() {
    static const BoundOptions<GaussOptions> all = [] {
      BoundOptions<GaussOptions> list{stages_option<GaussOptions>(
          "number of Gauss points; the order is twice this number", Range::whole_from(1, 10))};
      add_newton_options(list);
      return list;
    }();
    return all;
  }

  static MethodFamily declared() {
    return {
        .name = "gauss",
        .meaning = "Gauss collocation: symplectic, of any even order, for any twice differentiable H",
        .methods = {"gauss"},
        .options = declarations_of(options()),
        .read = [](const Texts& given) { return std::any(read(given)); },
        .rank = 2,
        .not_on_lattice = "an implicit step is not a bijection of the lattice",
        .representatives = {"gauss(1)", "gauss(2)", "gauss(3)", "gauss(4)"},
        .describe = [](std::size_t, const Texts& given) { return hamflow::describe(read(given)); },
        .needs = [](std::size_t) { return "a twice differentiable H"; },
        .advice =
            [](std::size_t) {
              return MethodAdvice{
                  .take = "H is not T(p) + V(q), the map must be symplectic, and the order high",
                  .avoid = "H = T(p) + V(q) and forces are cheap: kahan-li8; the energy must be exact: cg"};
            },
        .refused = [](const Texts& given) { return refused_together(options(), given); },
        .hint = [](const Texts& given, const UsableAdvice& usable) { return divergence_hint(read(given), usable); }};
  }

  template <class F>
  static auto visit(std::size_t, const std::any& given, F&& f) {
    return f(Averages{std::any_cast<const GaussOptions&>(given)});
  }

 private:
  static GaussOptions read(const Texts& given) { return read_newton(options(), given); }
};

}  // namespace hamflow::families
