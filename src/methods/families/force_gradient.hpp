// Splittings whose kicks carry the gradient of |V'|^2: every table of methods/force_gradient/.
#pragma once

#include <any>

#include "hamflow/methods/force_gradient.hpp"
#include "methods/splitting_shapes.hpp"

namespace hamflow::families {

struct ForceGradient {
  static MethodFamily declared() {
    MethodFamily family{
        .name = "force-gradient",
        .meaning = "splittings with the gradient of the force, for T quadratic with constant mass matrix"};
    for (const ForceGradientTable* table : force_gradient_tables()) family.methods.emplace_back(table->name);
    family.describe = [](std::size_t method, const Texts&) { return describe(*force_gradient_tables()[method]); };
    family.needs = [](std::size_t) { return needs_separable(true) + ", V twice differentiable"; };
    family.advice = [](std::size_t method) {
      return advice_of({.take = "V'' costs little compared with V': it gives order 4 without negative sub-steps"},
                       describe(*force_gradient_tables()[method]), true);
    };
    family.digits = [](std::size_t method) {
      int digits = unlimited_digits;
      for (const ForceGradientAction& action : force_gradient_tables()[method]->half) {
        digits =
            std::min({digits, known_digits(action.drift), known_digits(action.kick), known_digits(action.gradient)});
      }
      return digits;
    };
    return family;
  }

  template <class F>
  static auto visit(std::size_t method, const std::any&, F&& f) {
    return f(hamflow::ForceGradient{force_gradient_tables()[method]});
  }
};

}  // namespace hamflow::families
