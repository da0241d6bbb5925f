// Splittings with coefficients of their own: every table of methods/splittings/.
#pragma once

#include <any>

#include "methods/splitting_shapes.hpp"

namespace hamflow::families {

struct Splitting {
  static MethodFamily declared() {
    MethodFamily family{.name = "splitting",
                        .meaning =
                            "other splittings, for H = T(p) + V(q); some need T "
                            "quadratic with constant mass matrix"};
    for (const SplittingTable* table : splitting_tables()) family.methods.emplace_back(table->name);
    family.describe = [](std::size_t method, const Texts&) { return describe(*splitting_tables()[method]); };
    family.needs = [](std::size_t method) { return needs_separable(splitting_tables()[method]->nystroem); };
    family.advice = [](std::size_t method) {
      const SplittingTable& table = *splitting_tables()[method];
      return advice_of(table.advice, describe(table), table.nystroem);
    };
    family.digits = [](std::size_t method) { return known_digits(splitting_tables()[method]->coefficients); };
    return family;
  }

  template <class F>
  static auto visit(std::size_t method, const std::any&, F&& f) {
    return visit_shape(AnySplitting(*splitting_tables()[method]), f);
  }
};

}  // namespace hamflow::families
