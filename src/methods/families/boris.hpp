// The Boris push of a charge in a uniform magnetic field.
#pragma once

#include <any>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/boris.hpp"

namespace hamflow::families {

struct Boris {
  static MethodFamily declared() {
    return {.name = "boris",
            .meaning = "the Boris push of a charge in a magnetic field",
            .methods = {"boris"},
            .rank = 2,
            .not_on_lattice = "boris rotates velocities, which is not a bijection of the lattice",
            .describe = [](std::size_t, const Texts&) { return describe_boris(); },
            .needs = [](std::size_t) { return "a charge in a uniform magnetic field (problem magnetic)"; },
            .advice =
                [](std::size_t) {
                  return MethodAdvice{.take = "a charge in a magnetic field needs many cheap steps",
                                      .avoid =
                                          "few steps per turn must give the right phase of the gyration: taylor; the "
                                          "problem is another one: cg takes any H"};
                }};
  }
  template <class F>
  static auto visit(std::size_t, const std::any&, F&& f) {
    return f(hamflow::Boris{});
  }
};

}  // namespace hamflow::families
