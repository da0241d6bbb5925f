// Symmetric compositions of Stoermer-Verlet steps: every table of methods/compositions/, kick first and, as NAME-dkd,
// drift first.
#pragma once

#include <any>

#include "methods/splitting_shapes.hpp"

namespace hamflow::families {

struct Composition {
  static MethodFamily declared() {
    MethodFamily family{.name = "composition",
                        .meaning = "symmetric compositions of Stoermer-Verlet steps, for H = T(p) + V(q)"};
    for (const CompositionTable* table : composition_tables()) {
      family.methods.push_back(describe(*table, StartsWith::kick).name);
      family.methods.push_back(describe(*table, StartsWith::drift).name);
    }
    family.describe = [](std::size_t method, const Texts&) { return describe(table_of(method), starts_with(method)); };
    family.needs = [](std::size_t) { return needs_separable(false); };
    family.advice = [](std::size_t method) {
      const CompositionTable& table = table_of(method);
      const MethodInfo info = describe(table, starts_with(method));
      MethodAdvice advice = advice_of(table.advice, info, false);
      if (starts_with(method) == StartsWith::drift)
        advice.purpose.clear();  // the list of recommended methods has only one of the two
      return advice;
    };
    family.digits = [](std::size_t method) {
      const CompositionTable& table = table_of(method);
      return table.closed_half[0].empty() ? known_digits(table.half) : unlimited_digits;
    };
    return family;
  }

  template <class F>
  static auto visit(std::size_t method, const std::any&, F&& f) {
    return visit_shape(AnySplitting(table_of(method), starts_with(method)), f);
  }

 private:
  static const CompositionTable& table_of(std::size_t method) { return *composition_tables()[method / 2]; }
  static StartsWith starts_with(std::size_t method) { return method % 2 == 0 ? StartsWith::kick : StartsWith::drift; }
};

}  // namespace hamflow::families
