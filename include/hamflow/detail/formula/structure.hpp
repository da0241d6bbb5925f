// The structure of a typed Hamiltonian, known after it is parsed.
#pragma once

#include <cstddef>

namespace hamflow {

/// The properties that follow from the expression of a Hamiltonian.
struct FormulaStructure {
  bool separable = false;          // H = T(p) + V(q)
  bool quadratic_kinetic = false;  // T = p^T M^-1 p/2 with constant M, of the momenta that have names
  bool time = false;               // H depends on t
  std::size_t constraints = 0;     // how many g(q) = 0 there are
  bool multiplier = false;         // their multipliers are functions of the state
};

}  // namespace hamflow
