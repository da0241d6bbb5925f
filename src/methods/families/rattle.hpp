// Steps on the manifold of constraints.
#pragma once

#include <any>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/rattle.hpp"
#include "methods/newton_family.hpp"

namespace hamflow::families {

struct Rattle {
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
        .name = "rattle",
        .meaning = "symplectic steps on the manifold of constraints g(q) = 0, with residuals at rounding level",
        .methods = {"rattle", "rattle4"},
        .options = declarations_of(options()),
        .read = [](const Texts& given) { return std::any(read(given)); },
        .rank = 2,
        .not_on_lattice =
            "an implicit step is not a bijection of the lattice, and splitting methods do not support constraints; use "
            "another arithmetic, or generalised coordinates if H is T(p) + V(q) in them",
        .describe = [](std::size_t method, const Texts& given) { return hamflow::describe(of(method, read(given))); },
        .needs = [](std::size_t) { return "constraints g(q) = 0 and H = p^T M^-1 p/2 + V(q)"; },
        .advice =
            [](std::size_t method) {
              return MethodAdvice{.take = std::string("coordinates are subject to constraints, and ") +
                                          (method == 0 ? "order 2 is enough" : "order 4 is needed"),
                                  .avoid =
                                      "coordinates without constraints exist, such as angles: cg, gauss, or verlet if "
                                      "H is T(p) + V(q)"};
            },
        .refused = [](const Texts& given) { return refused_together(options(), given); },
        .hint = [](const Texts& given, const UsableAdvice& usable) { return divergence_hint(read(given), usable); }};
  }

  template <class F>
  static auto visit(std::size_t method, const std::any& given, F&& f) {
    return f(hamflow::Rattle{of(method, std::any_cast<const NewtonOptions&>(given))});
  }

 private:
  static NewtonOptions read(const Texts& given) { return read_newton(options(), given); }
  static RattleOptions of(std::size_t method, const NewtonOptions& options) { return {method == 0 ? 2 : 4, options}; }
};

}  // namespace hamflow::families
