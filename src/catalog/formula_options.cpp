#include "hamflow/detail/run/formula_options.hpp"

#include "hamflow/formula/problem_texts.hpp"

namespace hamflow {

const std::vector<OptionInfo>& central_formula_options() {
  static const std::vector<OptionInfo> options{
      {.name = CentralKeys::mass, .default_value = "1", .meaning = "reduced mass mu", .range = Range::positive},
      {.name = FormulaKeys::central_potential,
       .meaning = "V, a formula of r and the parameters",
       .type = OptionType::text,
       .required = true,
       .condition = "with potential = \"formula\"",
       .example = "-k/r - a/r^3"},
      {.name = FormulaKeys::parameters,
       .meaning = "numbers and lists by name; m[1] is the first number of the list m",
       .type = OptionType::table,
       .unset = "none",
       .condition = "with potential = \"formula\"",
       .example = "{ k = 1, a = 0.01 }"}};
  return options;
}

const OptionInfo& constraint_form_option() {
  static const OptionInfo option{
      .name = FormulaKeys::constraint_form,
      .default_value = FormulaKeys::manifold,
      .meaning =
          "manifold: steps stay on g(q) = 0 (rattle, rattle4); multiplier: the vector field whose multipliers are "
          "functions of the state (rk4, dop853, taylor), where g drifts",
      .type = OptionType::word,
      .words = {FormulaKeys::manifold, FormulaKeys::multiplier},
      .condition = "with constraints"};
  return option;
}

const std::vector<OptionInfo>& formula_options() {
  using Keys = FormulaKeys;
  static const std::vector<OptionInfo> options{
      {.name = Keys::coordinates,
       .meaning = "names of the coordinates; x[n], with a number or a whole parameter n, means x[1] to x[n]",
       .type = OptionType::word_list,
       .required = true,
       .example = "[x, y]"},
      {.name = Keys::momenta,
       .meaning = "names of the momenta",
       .type = OptionType::word_list,
       .unset = "p of q, p1 of q1, p_x of x, p_x[1] of x[1]",
       .example = "[p_x, p_y]"},
      {.name = Keys::hamiltonian,
       .meaning = "H, a formula of coordinates, momenta, parameters and t",
       .type = OptionType::text,
       .unset = "the sum of kinetic and potential",
       .example = "(p_x^2 + p_y^2)/(2*m) + k*(x^2 + y^2)/2 + x^2*y"},
      {.name = Keys::kinetic,
       .meaning = "T, a formula of the momenta",
       .type = OptionType::text,
       .unset = "found in hamiltonian",
       .condition = "in place of hamiltonian",
       .example = "(p_x^2 + p_y^2)/(2*m)"},
      {.name = Keys::potential,
       .meaning = "V, a formula of the coordinates",
       .type = OptionType::text,
       .unset = "found in hamiltonian",
       .condition = "in place of hamiltonian",
       .example = "k*(x^2 + y^2)/2 + x^2*y"},
      {.name = Keys::parameters,
       .meaning = "numbers and lists by name; m[1] is the first number of the list m",
       .type = OptionType::table,
       .unset = "none",
       .example = "{ k = 1, m = 1 }"},
      {.name = Keys::invariants,
       .meaning = "quantities to monitor in addition to H: formulas by name",
       .type = OptionType::table,
       .unset = "none",
       .example = "{ angular_momentum = \"x*p_y - y*p_x\" }"},
      {.name = Keys::constraints,
       .meaning = "functions g of coordinates and parameters that the motion keeps at 0; needs H = p^T M^-1 p/2 + V(q)",
       .type = OptionType::word_list,
       .unset = "none",
       .example = "[x^2 + y^2 - 1]"},
      constraint_form_option()};
  return options;
}

const std::vector<std::string>& formula_language() {
  static const std::vector<std::string> sentences{
      "a formula: + - * / ^ (also **, right-associative; -x^2 = -(x^2)), sqrt exp log sin cos tan asin acos atan atan2 "
      "sinh "
      "cosh "
      "tanh abs, pi, t for the time, names of coordinates, momenta and parameters",
      "let r = sqrt(x^2 + y^2), u = 1/r in ... names subexpressions; sum(i, 1, n - 1, (x[i+1] - x[i])^2) is a sum"};
  return sentences;
}

}  // namespace hamflow
