// **The model of a typed Hamiltonian**: its names, its structure (separable, T quadratic, dependent on the time), and
// code for H, its exact derivatives and its invariants. It holds for all values of the parameters and is shared by all
// runs; bound_model.hpp adds the values.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/detail/core/step_clock.hpp"
#include "hamflow/formula/formula.hpp"
#include "hamflow/formula/problem_texts.hpp"

namespace hamflow {

namespace formula {

/// The entries (row, column) of a matrix that are not 0 everywhere, in the order of the outputs of the code.
using Entries = std::vector<std::pair<std::size_t, std::size_t>>;

struct HessianCode {
  std::shared_ptr<const Code> code;
  Entries qq, qp, pp;  // qq and pp with row <= column
};
struct ForceAndHessianCode {
  std::shared_ptr<const Code> code;  // the force, then
  Entries entries;                   // with row <= column
};

class Model {
 public:
  /// @throws FormulaError if a text is wrong, or if its derivatives are too long
  explicit Model(const FormulaTexts& texts);
  ~Model();
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  /// The number of coordinates with names.
  std::size_t size() const { return coordinates_.size(); }
  /// The degrees of freedom of the functions below. If H depends on t, two more coordinates carry the time: the time
  /// since the present step began, with the momentum E, and the time at which the step began, which the motion does not
  /// change (detail/core/step_clock.hpp). t is their sum, rounded once. The functions are those of H(q, p, t) + E.
  /// Along a trajectory t' = 1 and E' = -dH/dt, so H + E is conserved, and its deviation is H - H(0) - int dH/dt. There
  /// are derivatives by both coordinates, because methods estimate rounding by a derivative times a coordinate, and
  /// late in a run the time at which a step began has a rounding error larger than the step. A separable H stays
  /// separable if T does not depend on t: a kick is evaluated at the time of its stage.
  std::size_t degrees() const { return size() + (structure_.time ? clock_coordinates : 0); }
  const std::vector<std::string>& coordinates() const { return coordinates_; }  // x[1], x[2], ...
  const std::vector<std::string>& momenta() const { return momenta_; }
  const std::vector<std::string>& invariants() const { return invariant_names_; }
  const FormulaStructure& structure() const { return structure_; }
  /// The texts in one line, for saved states.
  const std::string& label() const { return label_; }
  /// The symbols in the order of their values: coordinates, momenta, t, parameters. `known` has the values that indices
  /// needed.
  const FormulaSymbols& symbols() const { return symbols_; }
  std::size_t time_symbol() const { return 2 * size(); }
  /// The symbol of the factor of scaled_force and scaled_velocity. It follows all others. After it come the symbols of
  /// the momenta of both time coordinates; H + E does not contain the second one.
  std::size_t factor_symbol() const { return symbols_.names.size(); }
  std::size_t time_momentum_symbol() const { return symbols_.names.size() + 1; }
  /// The symbols of the i-th coordinate and of its momentum, i < degrees().
  std::size_t position_symbol(std::size_t i) const { return i < size() ? i : time_symbol(); }
  std::size_t momentum_symbol(std::size_t i) const {
    return i < size() ? size() + i : time_momentum_symbol() + (i - size());
  }
  /// The name of a parameter symbol and its index in the list.
  struct ParameterPlace {
    std::string name;
    std::size_t index;
  };
  const ParameterPlace& parameter(int symbol) const {
    return places_.at(static_cast<std::size_t>(symbol) - 2 * size() - 1);
  }
  const std::vector<ParameterPlace>& parameters() const { return places_; }

  std::shared_ptr<const Code> energy, kinetic, potential, velocity, force, gradient;  // gradient: dH/dq, then dH/dp
  std::shared_ptr<const Code> invariant_values;
  /// For constraints: g; g', row by row, with degrees() columns; g''(p, p), where p stands for a velocity.
  std::shared_ptr<const Code> constraints, constraint_gradients, constraint_curvatures;
  /// factor f and factor v, with the factor multiplied into the constants (core/derivatives.hpp), for a force that is a
  /// scalar times the position, as in central fields; else null.
  std::shared_ptr<const Code> scaled_force, scaled_velocity;
  /// Second derivatives. Each function derives them when it is first called.
  const HessianCode& hessian() const;
  const ForceAndHessianCode& force_and_hessian() const;

 private:
  struct Derivation;
  /// @param values the nodes of g in the graph
  void derive_constraints(const std::vector<int>& values);

  std::vector<std::string> coordinates_;
  std::vector<std::string> momenta_;
  std::vector<std::string> invariant_names_;
  FormulaSymbols symbols_;
  std::vector<ParameterPlace> places_;
  FormulaStructure structure_;
  std::string label_;
  std::unique_ptr<Derivation> derivation_;
  mutable std::mutex mutex_;
  mutable std::unique_ptr<HessianCode> hessian_;
  mutable std::unique_ptr<ForceAndHessianCode> force_and_hessian_;
};

}  // namespace formula
}  // namespace hamflow
