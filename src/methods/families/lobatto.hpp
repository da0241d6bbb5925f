// The Lobatto pair IIIA-IIIB.
#pragma once

#include <any>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/lobatto.hpp"
#include "methods/newton_family.hpp"

namespace hamflow::families {

struct Lobatto {
  static const BoundOptions<LobattoOptions>& options() {
    static const BoundOptions<LobattoOptions> all = [] {
      BoundOptions<LobattoOptions> list{
          stages_option<LobattoOptions>("number of stages; the order is 2*stages - 2", Range::whole_from(2, 10))};
      add_newton_options(list);
      return list;
    }();
    return all;
  }

  static MethodFamily declared() {
    return {
        .name = "lobatto-3a-3b",
        .meaning =
            "the partitioned Runge-Kutta pair of Lobatto: symplectic, of any even order, for any twice "
            "differentiable H",
        .methods = {"lobatto-3a-3b"},
        .options = declarations_of(options()),
        .read = [](const Texts& given) { return std::any(read(given)); },
        .rank = 2,
        .not_on_lattice = "an implicit step is not a bijection of the lattice",
        .representatives = {"lobatto-3a-3b(2)", "lobatto-3a-3b(3)", "lobatto-3a-3b(4)"},
        .describe = [](std::size_t, const Texts& given) { return hamflow::describe(read(given)); },
        .needs = [](std::size_t) { return "a twice differentiable H"; },
        .advice =
            [](std::size_t) {
              return MethodAdvice{
                  .take =
                      "H is not T(p) + V(q), and you need a generalisation of verlet of any even order (two stages are "
                      "verlet if H = T(p) + V(q))",
                  .avoid = "a high order with few stages is needed: gauss; the energy must be exact: cg"};
            },
        .refused = [](const Texts& given) { return refused_together(options(), given); },
        .hint = [](const Texts& given, const UsableAdvice& usable) { return divergence_hint(read(given), usable); }};
  }

  template <class F>
  static auto visit(std::size_t, const std::any& given, F&& f) {
    return f(hamflow::Lobatto{std::any_cast<const LobattoOptions&>(given)});
  }

 private:
  static LobattoOptions read(const Texts& given) { return read_newton(options(), given); }
};

}  // namespace hamflow::families
