// Energy and momentum together.
#pragma once

#include <any>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/eg.hpp"
#include "methods/newton_family.hpp"

namespace hamflow::families {

struct Eg {
  static const BoundOptions<EgOptions>& options() {
    static const BoundOptions<EgOptions> all = [] {
      BoundOptions<EgOptions> list{degree_option<EgOptions>(
          "polynomial degree in time and number of Gauss points; the order is twice this number",
          Range::whole_from(1, 3))};
      add_newton_options(list);
      return list;
    }();
    return all;
  }

  static MethodFamily declared() {
    return {
        .name = "eg",
        .meaning =
            "enhanced elements that conserve energy, linear and angular momentum of bodies in Cartesian coordinates",
        .methods = {"eg"},
        .options = declarations_of(options()),
        .read = [](const Texts& given) { return std::any(read(given)); },
        .rank = 2,
        .not_on_lattice = "an implicit step is not a bijection of the lattice",
        .representatives = {"eg(1)", "eg(2)", "eg(3)"},
        .describe = [](std::size_t, const Texts& given) { return hamflow::describe(read(given)); },
        .needs =
            [](std::size_t) {
              return "an H of bodies whose forces act along the lines between them or to a centre and depend only on "
                     "the distance (n-body, solar-system, gas without a container, central-force with a named "
                     "potential and Cartesian coordinates)";
            },
        .advice =
            [](std::size_t) {
              return MethodAdvice{.take =
                                      "both energy and angular momentum must be exact, for bodies, a gas without a "
                                      "container or a central force in Cartesian coordinates",
                                  .avoid =
                                      "H has no such forces: cg; the run must reverse bit for bit (lattice), or many "
                                      "cheap steps are enough: kahan-li8, rkn8-s19"};
            },
        .refused = [](const Texts& given) { return refused_together(options(), given); },
        .hint = [](const Texts& given, const UsableAdvice& usable) { return divergence_hint(read(given), usable); }};
  }

  template <class F>
  static auto visit(std::size_t, const std::any& given, F&& f) {
    return f(hamflow::Eg{std::any_cast<const EgOptions&>(given)});
  }

 private:
  static EgOptions read(const Texts& given) { return read_newton(options(), given); }
};

}  // namespace hamflow::families
