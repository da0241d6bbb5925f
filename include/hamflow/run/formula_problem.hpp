// Typed Hamiltonians in C++ programs: makes a problem from a text.
//
//     const auto pendulum = formula_problem("p^2/2 - k*cos(q)", {{"k", "2"}});
//     auto run = simulate(pendulum, Cg{}, {0.5}, {0.0}, 0.1);
//
// The capabilities of H are known when the text is parsed, but the C++ type must be known before. formula_problem
// accepts any H and has gradient and Hessian, for implicit and Runge-Kutta methods. separable_formula_problem accepts H
// = T(p) + V(q), also for splitting methods; natural_formula_problem accepts H = p^T M^-1 p/2 + V(q). By name
// (run/catalog.hpp) all methods that apply are available: request.problem = "formula", request.variant =
// formula_choices(texts).
#pragma once

#include "hamflow/detail/run/formula_functions.hpp"

namespace hamflow {

template <Capability c>
using FormulaProblem = AnyProblem<double, c, Trace<double>, Dual<double, 1>>;

/// @throws FormulaError if a text is wrong, or the Hamiltonian does not have the capability c
template <Capability c>
FormulaProblem<c> typed_problem(const FormulaTexts& texts) {
  auto model = std::make_shared<const formula::Model>(texts);
  require_of_formula(model->structure(), c);
  const auto bound = std::make_shared<const formula::BoundModel<double>>(model, Parameters<double>(texts.parameters));
  return {model->degrees(), std::make_shared<FormulaFunctions<double, double>>(bound),
          std::make_shared<FormulaFunctions<double, Trace<double>>>(bound),
          std::make_shared<FormulaFunctions<double, Dual<double, 1>>>(bound)};
}

/// Any H. @throws FormulaError if a text is wrong
inline FormulaProblem<Capability::smooth> formula_problem(const FormulaTexts& texts) {
  return typed_problem<Capability::smooth>(texts);
}
inline FormulaProblem<Capability::smooth> formula_problem(const std::string& hamiltonian,
                                                          const Texts& parameters = {}) {
  return formula_problem(texts_of_hamiltonian(hamiltonian, parameters));
}
/// H = T(p) + V(q). @throws FormulaError when a text is wrong, or H is not of this form
inline FormulaProblem<Capability::separable> separable_formula_problem(const FormulaTexts& texts) {
  return typed_problem<Capability::separable>(texts);
}
inline FormulaProblem<Capability::separable> separable_formula_problem(const std::string& hamiltonian,
                                                                       const Texts& parameters = {}) {
  return separable_formula_problem(texts_of_hamiltonian(hamiltonian, parameters));
}
/// H = p^T M^-1 p/2 + V(q) with constant M. @throws FormulaError when a text is wrong, or H is not of this form
inline FormulaProblem<Capability::separable | Capability::quadratic_kinetic> natural_formula_problem(
    const FormulaTexts& texts) {
  return typed_problem<Capability::separable | Capability::quadratic_kinetic>(texts);
}
inline FormulaProblem<Capability::separable | Capability::quadratic_kinetic> natural_formula_problem(
    const std::string& hamiltonian, const Texts& parameters = {}) {
  return natural_formula_problem(texts_of_hamiltonian(hamiltonian, parameters));
}

}  // namespace hamflow
