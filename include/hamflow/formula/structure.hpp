// What is known of a typed Hamiltonian once it is read.
#pragma once

namespace hamflow {

/// What is found from the expression of a Hamiltonian.
struct FormulaStructure {
  bool separable = false;          // H = T(p) + V(q)
  bool quadratic_kinetic = false;  // T = p^T M^-1 p/2 with constant M, of the momenta that have names
  bool time = false;               // H depends on t
};

}  // namespace hamflow
