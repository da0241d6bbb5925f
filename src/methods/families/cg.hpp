// Energy-conserving Petrov-Galerkin finite elements in time.
#pragma once

#include <any>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/averages.hpp"
#include "hamflow/methods/cg.hpp"
#include "methods/newton_family.hpp"

namespace hamflow::families {

struct Cg {
  static const BoundOptions<CgOptions>& options() {
    static const BoundOptions<CgOptions> all = [] {
      BoundOptions<CgOptions> list{degree_option<CgOptions>("polynomial degree in time; the order is twice the degree",
                                                            Range::whole_from(1, most_gauss_points - 1)),
                                   quadrature_option<CgOptions>(2)};
      add_newton_options(list);
      return list;
    }();
    return all;
  }

  static MethodFamily declared() {
    return {
        .name = "cg",
        .meaning = "finite elements in time that conserve the energy, for any twice differentiable H",
        .methods = {"cg"},
        .options = declarations_of(options()),
        .read = [](const Texts& given) { return std::any(read(given)); },
        .rank = 1,
        .not_on_lattice = "an implicit step is not a bijection of the lattice",
        .representatives = {"cg(1,1)", "cg(1,2)", "cg(1,5)", "cg(1,auto)", "cg(2,2)", "cg(2,3)", "cg(2,auto)",
                            "cg(3,4)", "cg(3,auto)", "cg(4,auto)"},
        .describe = [](std::size_t, const Texts& given) { return hamflow::describe(read(given)); },
        .needs = [](std::size_t) { return "a twice differentiable H"; },
        .advice =
            [](std::size_t) {
              return MethodAdvice{
                  .purpose = "any twice differentiable H; the energy error is at rounding level for any dt",
                  .take = "H is not T(p) + V(q), the energy must be exact, or the motion is stiff",
                  .avoid =
                      "many cheap steps are enough for H = T(p) + V(q): verlet, kahan-li8; the run "
                      "must reverse bit for bit (lattice): stv4; the angular momentum in Cartesian "
                      "coordinates must be conserved: verlet"};
            },
        .refused = refused,
        .hint = [](const Texts& given, const UsableAdvice& usable) { return divergence_hint(read(given), usable); }};
  }

  /// cg(1) with Newton has special kernels, compiled with each problem.
  template <class F>
  static auto visit(std::size_t, const std::any& given, F&& f) {
    const auto& chosen = std::any_cast<const CgOptions&>(given);
    if (chosen.degree == 1 && chosen.iteration == Iteration::newton) return f(hamflow::Cg{chosen});
    return f(Averages{chosen});
  }

 private:
  static CgOptions read(const Texts& given) { return read_newton(options(), given); }
  static std::pair<std::string, std::string> refused(const Texts& given) {
    const CgOptions chosen = read(given);
    if (chosen.quadrature != 0 && chosen.quadrature < chosen.degree) {
      return {options()[1].info.name, "found " + std::to_string(chosen.quadrature) + "; allowed at least the degree, " +
                                          std::to_string(chosen.degree) + ", or \"auto\""};
    }
    return refused_together(options(), given);
  }
};

}  // namespace hamflow::families
