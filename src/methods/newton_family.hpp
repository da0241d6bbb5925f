// Options of the families that solve their steps by iteration. They set the members of NewtonOptions.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/averages.hpp"

namespace hamflow::families {

/// The options that are replaced for systems of very many unknowns.
inline constexpr const char* iteration_option = "iteration";
inline constexpr const char* max_iterations_option = "max_iterations";

/// The number of Gauss points of elements. @param position among the options
template <class Options>
BoundOption<Options> quadrature_option(int position) {
  return bind_number({.name = "quadrature",
                      .default_value = "auto",
                      .meaning = "number of Gauss points, for cg at least its degree; auto: the smallest number that "
                                 "keeps the energy error at "
                                 "rounding level",
                      .range = Range::whole_from(1, 64),
                      .position = position},
                     &Options::quadrature, {{"auto", 0}});
}

/// The degree of polynomials in time, the first option by position.
template <class Options>
BoundOption<Options> degree_option(std::string meaning, Range range) {
  return bind_number(
      {.name = "degree", .default_value = "1", .meaning = std::move(meaning), .range = range, .position = 1},
      &Options::degree);
}

/// The number of stages, the first option by position.
template <class Options>
BoundOption<Options> stages_option(std::string meaning, Range range) {
  return bind_number(
      {.name = "stages", .default_value = "2", .meaning = std::move(meaning), .range = range, .position = 1},
      &Options::stages);
}

/// tolerance, criterion, max_iterations, iteration, on_divergence, diagnostics, in this order.
template <class Options>
void add_newton_options(BoundOptions<Options>& all) {
  all.push_back(
      bind_number({.name = tolerance_option,
                   .meaning = "limit of the 2-norm of the residual (for cg(1), of the residual (2.63) of Gross1999)",
                   .range = Range::positive,
                   .unset = "the rounding level of the residual; 1e-13 with criterion seed",
                   .example = "1e-13"},
                  &Options::tolerance));
  all.push_back(
      bind_word({.name = "criterion",
                 .default_value = "stagnation",
                 .meaning = "seed: stagnation above the tolerance is an error, as in the programs of the thesis"},
                &Options::seed_criterion, {{"stagnation", false}, {"seed", true}}));
  all.push_back(
      bind_number({.name = max_iterations_option,
                   .default_value = "15",
                   .meaning = "largest number of corrections per attempt at a step; other initial guesses and half "
                              "steps are further attempts. The default is 100 for iterations other than newton",
                   .range = Range::whole_from(1, 1000)},
                  &Options::max_iterations));
  all.push_back(bind_word(
      {.name = iteration_option,
       .default_value = "newton",
       .meaning =
           "how the equations of a step are solved, from an extrapolated initial guess: newton with the exact "
           "Jacobian; simplified with one factored Jacobian per step; fixed-point with first derivatives only; "
           "fixed-point-or-newton with newton if fixed-point does not converge (the default for sparse systems of 100 "
           "unknowns and more of a typed H, if it costs less); systems of more than 500 unknowns use fixed-point"},
      &Options::iteration,
      {{"newton", Iteration::newton},
       {"simplified", Iteration::simplified},
       {"fixed-point", Iteration::fixed_point},
       {"fixed-point-or-newton", Iteration::fixed_point_or_newton}}));
  all.push_back(bind_word({.name = "on_divergence",
                           .default_value = "error",
                           .meaning = "halve: replace a step that does not converge by two half steps"},
                          &Options::halve, {{"error", false}, {"halve", true}}));
  all.push_back(bind_yes_no(
      {.name = diagnostics_option,
       .default_value = "false",
       .meaning = "compute the condition number and the determinant of the Jacobian, and the condition number of M^-1, "
                  "at every step"},
      &Options::diagnostics));
}

/// The declared name of the option that sets a member.
template <class Options>
const std::string& last_option(const BoundOptions<Options>& all, std::size_t from_end) {
  return all[all.size() - 1 - from_end].info.name;
}

/// Reads the options and sets defaults that depend on other options.
template <class Options>
Options read_newton(const BoundOptions<Options>& options, const Texts& given) {
  Options read = read_options(options, given);
  if (read.seed_criterion && !read.tolerance) read.tolerance = 1e-13;  // as in the listings
  if (read.iteration != Iteration::newton && !given.contains(max_iterations_option)) {
    read.max_iterations = linear_iterations;
  }
  return read;
}

/// Refuses options that cannot be combined: the option at fault, and why.
template <class Options>
std::pair<std::string, std::string> refused_together(const BoundOptions<Options>& options, const Texts& given) {
  const Options read = read_newton(options, given);
  if (read.diagnostics && first_iteration(read.iteration) == Iteration::fixed_point) {
    return {last_option(options, 0), "found true; allowed false, since a fixed-point iteration has no Jacobian"};
  }
  return {};
}

/// Advice after a step that did not converge. The reason is unknown here, so each part says when it helps.
template <class Options>
std::string divergence_hint(const Options& read, const UsableAdvice& usable) {
  const int usual = read.iteration == Iteration::newton ? Options{}.max_iterations : linear_iterations;
  std::string text = "try ";
  if (read.max_iterations < usual) {
    text +=
        std::string("a larger method.") + max_iterations_option + " (the default is " + std::to_string(usual) + "), ";
  }
  text += std::string("a smaller dt, ") + (read.halve || !usable.halving ? "" : "method.on_divergence = \"halve\", ") +
          (usable.newton && read.iteration != Iteration::newton ? "method.iteration = \"newton\", " : "") +
          "or, if the residual stagnates above method.tolerance, a larger tolerance or none";
  if constexpr (requires { read.quadrature; }) {
    if (read.quadrature == 0 && !usable.without_quadrature.empty()) {
      text += "; if H has a kink or a jump, which quadrature cannot resolve, method.name = \"" +
              usable.without_quadrature + "\"";
    }
  }
  return text;
}

}  // namespace hamflow::families
