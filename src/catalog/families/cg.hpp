// Energy-conserving Petrov-Galerkin finite elements in time.
#pragma once

#include "hamflow/methods/cg.hpp"
#include "hamflow/run/method_family.hpp"
#include "newton_family.hpp"

namespace hamflow::families {

struct Cg {
  static const BoundOptions<CgOptions>& options() {
    static const BoundOptions<CgOptions> all{
        bind_number({.name = "degree",
                     .default_value = "1",
                     .meaning = "polynomial degree in time: 1 in this version",
                     .range = Range::whole_from(1, 1),
                     .position = 1},
                    &CgOptions::degree),
        bind_number({.name = "quadrature",
                     .default_value = "auto",
                     .meaning = "Gauss points, at least the degree; auto: as few as keep H at its rounding",
                     .range = Range::whole_from(1, most_gauss_points),
                     .position = 2},
                    &CgOptions::quadrature, {{"auto", 0}}),
        bind_number({.name = tolerance_option,
                     .meaning = "on the 2-norm of the residual (2.63) of Gross1999",
                     .range = Range::positive,
                     .unset = "its rounding level; 1e-13 with criterion seed",
                     .example = "1e-13"},
                    &CgOptions::tolerance),
        bind_word({.name = "criterion",
                   .default_value = "stagnation",
                   .meaning = "with seed stagnation above the tolerance is an error, as in the thesis' programs"},
                  &CgOptions::seed_criterion, {{"stagnation", false}, {"seed", true}}),
        max_iterations_option<CgOptions>(),
        {{.name = "iteration",
          .default_value = "newton",
          .meaning = "how the equations of a step are solved",
          .type = OptionType::word,
          .words = {"newton"}},
         [](CgOptions&, const std::string&) {}},
        divergence_option<CgOptions>(),
        diagnostics_option<CgOptions>()};
    return all;
  }

  static CgOptions read(const Texts& given) {
    CgOptions read = read_options(options(), given);
    if (read.seed_criterion && !read.tolerance) read.tolerance = 1e-13;  // the listings' own
    return read;
  }

  static MethodFamily declared() {
    return {.name = "cg",
            .meaning = "finite elements in time that conserve the energy, for any twice differentiable H",
            .methods = {"cg"},
            .options = declarations_of(options()),
            .rank = 1,
            .not_on_lattice = "an implicit step is no bijection of the lattice; use a splitting method, e.g. stv4",
            .not_fast = "an energy-conserving element needs the exact force",
            .representatives = {"cg(1,1)", "cg(1,2)", "cg(1,5)", "cg(1,auto)"},
            .describe = [](std::size_t, const Texts& given) { return hamflow::describe(read(given)); },
            .needs = [](std::size_t) { return "a twice differentiable H"; },
            .advice =
                [](std::size_t) {
                  return MethodAdvice{
                      .purpose = "any twice differentiable H; keeps the energy to rounding, whatever dt is",
                      .take = "H is not T(p) + V(q), the energy has to be exact, or the motion is stiff",
                      .avoid =
                          "many cheap steps do for H = T(p) + V(q): verlet, kahan-li8; bits have to come back "
                          "(lattice): stv4; the angular momentum in Cartesian coordinates has to be kept: verlet"};
                },
            .refused = refused,
            .hint =
                [](const Texts& given) {
                  return std::string("try a smaller dt, ") +
                         (read(given).halve ? "" : "method.on_divergence = \"halve\", ") +
                         "or, if the residual stagnates above method.tolerance, a larger tolerance or none";
                }};
  }

  template <class F>
  static auto visit(std::size_t, const Texts& given, F&& f) {
    return f(hamflow::Cg{read(given)});
  }

 private:
  static std::pair<std::string, std::string> refused(const Texts& given) {
    const CgOptions read = Cg::read(given);
    if (read.quadrature == 0 || read.quadrature >= read.degree) return {};
    return {options()[1].info.name, "found " + std::to_string(read.quadrature) + "; allowed at least the degree, " +
                                        std::to_string(read.degree) + ", or \"auto\""};
  }
};

}  // namespace hamflow::families
