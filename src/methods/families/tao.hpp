// Explicit symplectic steps for any H in a doubled phase space.
#pragma once

#include <any>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/tao.hpp"

namespace hamflow::families {

struct Tao {
  static const BoundOptions<TaoOptions>& options() {
    static const BoundOptions<TaoOptions> all{
        bind_number({.name = "omega",
                     .default_value = "20",
                     .meaning = "frequency of the springs between the two copies of the state, 1/time. It must exceed "
                                "the second derivatives of H by q and by p, or the copies separate; the error grows as "
                                "omega dt^order, so keep omega dt below 1/4",
                     .range = Range::positive,
                     .position = 1},
                    &TaoOptions::omega)};
    return all;
  }

  static MethodFamily declared() {
    return {.name = "tao",
            .meaning = "explicit symplectic steps for any differentiable H, with two coupled copies of the state",
            .methods = {"tao2", "tao4"},
            .options = declarations_of(options()),
            .read = [](const Texts& given) { return std::any(read_options(options(), given)); },
            .rank = 1,
            .not_on_lattice =
                "the two copies of the state rotate about each other, which is not a bijection of the lattice",
            .describe =
                [](std::size_t method, const Texts& given) {
                  return describe_tao(method == 0 ? 2 : 4, read_options(options(), given));
                },
            .needs = [](std::size_t) { return "a differentiable H"; },
            .advice =
                [](std::size_t method) {
                  return MethodAdvice{.take = std::string("H is not T(p) + V(q), and an explicit step ") +
                                              (method == 0 ? "of order 2" : "of order 4") +
                                              " must keep a modified energy for a long time",
                                      .avoid =
                                          "H is T(p) + V(q): verlet, stv4, kahan-li8 cost less; the energy must be "
                                          "exact, or the motion is stiff: cg"};
                }};
  }

  template <class F>
  static auto visit(std::size_t method, const std::any& given, F&& f) {
    const auto& chosen = std::any_cast<const TaoOptions&>(given);
    if (method == 0) return f(hamflow::Tao<2>{chosen});
    return f(hamflow::Tao<4>{chosen});
  }
};

}  // namespace hamflow::families
