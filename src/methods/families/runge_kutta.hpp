// Explicit Runge-Kutta methods with fixed steps: every tableau of methods/tableaus/.
#pragma once

#include <any>

#include "catalog_tables.hpp"  // generated from the folders of tables
#include "hamflow/detail/run/method_family.hpp"

namespace hamflow::families {

struct RungeKutta {
  static MethodFamily declared() {
    MethodFamily family{
        .name = "runge-kutta",
        .meaning = "explicit Runge-Kutta methods with fixed steps, for comparison; their energy drifts",
        .not_on_lattice =
            "an explicit Runge-Kutta step is not a bijection of the lattice, so it could not be reversed exactly"};
#define HAMFLOW_DECLARE_TABLEAU(table) family.methods.emplace_back(tableaus::table.name);
    HAMFLOW_FOR_EACH_TABLEAU(HAMFLOW_DECLARE_TABLEAU)
#undef HAMFLOW_DECLARE_TABLEAU
    family.describe = [](std::size_t method, const Texts&) {
      static const std::vector<MethodInfo> all{
#define HAMFLOW_DESCRIBE_TABLEAU(table) describe(tableaus::table),
          HAMFLOW_FOR_EACH_TABLEAU(HAMFLOW_DESCRIBE_TABLEAU)
#undef HAMFLOW_DESCRIBE_TABLEAU
      };
      return all[method];
    };
    family.advice = [](std::size_t) -> MethodAdvice {
      return {.take = "you want to see what a method that is not symplectic does, or the run is a fraction of a period",
              .avoid =
                  "the run is long, because its energy drifts: verlet, stv4 for H = T(p) + V(q), cg for any H; you "
                  "need a reference: taylor, dop853"};
    };
    family.needs = [](std::size_t) { return "a differentiable H"; };
    return family;
  }

  template <class F>
  static auto visit(std::size_t method, const std::any&, F&& f) {
    std::size_t at = 0;
#define HAMFLOW_VISIT_TABLEAU(table) \
  if (method == at++) return f(RungeKuttaBy<tableaus::table>{});
    HAMFLOW_FOR_EACH_TABLEAU(HAMFLOW_VISIT_TABLEAU)
#undef HAMFLOW_VISIT_TABLEAU
    throw std::logic_error("hamflow: no such tableau");
  }
};

}  // namespace hamflow::families
