// What the families share whose steps are solved by iteration. The members are those of NewtonOptions.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/averages.hpp"

namespace hamflow::families {

/// The options that a system of very many unknowns does not take as they are given.
inline constexpr const char* iteration_option = "iteration";
inline constexpr const char* max_iterations_option = "max_iterations";

/// Of elements: the Gauss points. @param position among the options
template <class Options>
BoundOption<Options> quadrature_option(int position) {
  return bind_number({.name = "quadrature",
                      .default_value = "auto",
                      .meaning = "Gauss points, of cg at least its degree; auto: as few as keep H at its rounding",
                      .range = Range::whole_from(1, 64),
                      .position = position},
                     &Options::quadrature, {{"auto", 0}});
}

/// Of polynomials in time: their degree, by position the first of the options.
template <class Options>
BoundOption<Options> degree_option(std::string meaning, Range range) {
  return bind_number(
      {.name = "degree", .default_value = "1", .meaning = std::move(meaning), .range = range, .position = 1},
      &Options::degree);
}

/// Of methods in stages: how many, by position the first of the options.
template <class Options>
BoundOption<Options> stages_option(std::string meaning, Range range) {
  return bind_number(
      {.name = "stages", .default_value = "2", .meaning = std::move(meaning), .range = range, .position = 1},
      &Options::stages);
}

/// tolerance, criterion, max_iterations, iteration, on_divergence, diagnostics, in this order.
template <class Options>
void add_newton_options(BoundOptions<Options>& all) {
  all.push_back(bind_number({.name = tolerance_option,
                             .meaning = "on the 2-norm of the residual, for cg(1) that of (2.63) of Gross1999",
                             .range = Range::positive,
                             .unset = "its rounding level; 1e-13 with criterion seed",
                             .example = "1e-13"},
                            &Options::tolerance));
  all.push_back(
      bind_word({.name = "criterion",
                 .default_value = "stagnation",
                 .meaning = "with seed stagnation above the tolerance is an error, as in the thesis' programs"},
                &Options::seed_criterion, {{"stagnation", false}, {"seed", true}}));
  all.push_back(bind_number(
      {.name = max_iterations_option,
       .default_value = "15",
       .meaning =
           "corrections of each attempt at a step, of which other first guesses and half steps make several; 100 where "
           "nothing is said and newton is not taken",
       .range = Range::whole_from(1, 1000)},
      &Options::max_iterations));
  all.push_back(bind_word(
      {.name = iteration_option,
       .default_value = "newton",
       .meaning = "how the equations of a step are solved, from the last steps continued: newton with the exact "
                  "tangent, simplified with one factored once a step, fixed-point with none, from first derivatives, "
                  "fixed-point-or-newton with newton where that does not converge; sparse systems of "
                  "100 unknowns and more of a typed H take it where nothing is said and it costs less; systems of more "
                  "than 500 unknowns take fixed-point"},
      &Options::iteration,
      {{"newton", Iteration::newton},
       {"simplified", Iteration::simplified},
       {"fixed-point", Iteration::fixed_point},
       {"fixed-point-or-newton", Iteration::fixed_point_or_newton}}));
  all.push_back(bind_word({.name = "on_divergence",
                           .default_value = "error",
                           .meaning = "halve: two half steps in place of one that does not converge"},
                          &Options::halve, {{"error", false}, {"halve", true}}));
  all.push_back(bind_yes_no({.name = diagnostics_option,
                             .default_value = "false",
                             .meaning = "condition and determinant of the tangent, condition of M^-1, at every step"},
                            &Options::diagnostics));
}

/// The declared name of the option that sets a member.
template <class Options>
const std::string& last_option(const BoundOptions<Options>& all, std::size_t from_end) {
  return all[all.size() - 1 - from_end].info.name;
}

/// The options with those that follow from others.
template <class Options>
Options read_newton(const BoundOptions<Options>& options, const Texts& given) {
  Options read = read_options(options, given);
  if (read.seed_criterion && !read.tolerance) read.tolerance = 1e-13;  // the listings' own
  if (read.iteration != Iteration::newton && !given.contains(max_iterations_option)) {
    read.max_iterations = linear_iterations;
  }
  return read;
}

/// What does not go together: the option to blame, and why.
template <class Options>
std::pair<std::string, std::string> refused_together(const BoundOptions<Options>& options, const Texts& given) {
  const Options read = read_newton(options, given);
  if (read.diagnostics && first_iteration(read.iteration) == Iteration::fixed_point) {
    return {last_option(options, 0), "found true; allowed false, since a fixed-point iteration has no tangent"};
  }
  return {};
}

/// Why a step found no solution is not known here, so that each advice says when it helps.
template <class Options>
std::string divergence_hint(const Options& read, const UsableAdvice& usable) {
  const int usual = read.iteration == Iteration::newton ? Options{}.max_iterations : linear_iterations;
  std::string text = "try ";
  if (read.max_iterations < usual) {
    text += std::string("a larger method.") + max_iterations_option + " (" + std::to_string(usual) + " unless said), ";
  }
  text += std::string("a smaller dt, ") + (read.halve || !usable.halving ? "" : "method.on_divergence = \"halve\", ") +
          (usable.newton && read.iteration != Iteration::newton ? "method.iteration = \"newton\", " : "") +
          "or, if the residual stagnates above method.tolerance, a larger tolerance or none";
  if constexpr (requires { read.quadrature; }) {
    if (read.quadrature == 0 && !usable.without_quadrature.empty()) {
      text += "; where H has a kink or a jump, which no quadrature resolves, method.name = \"" +
              usable.without_quadrature + "\"";
    }
  }
  return text;
}

}  // namespace hamflow::families
