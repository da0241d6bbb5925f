// The names of a typed problem: x[n] written out, momenta by default, clashes.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "hamflow/formula/formula.hpp"
#include "hamflow/formula/problem_texts.hpp"

namespace hamflow::formula {

struct ProblemNames {
  std::vector<std::string> coordinates;
  std::vector<std::string> momenta;
  struct Parameter {
    std::string name;
    std::size_t length;          // of a list; 0: one number
    std::vector<double> values;  // NaN: not known
  };
  std::vector<Parameter> parameters;
  /// Parameters whose values were needed for sizes.
  std::set<std::string> whole;
};

/// @throws FormulaError
ProblemNames names_of(const FormulaTexts& texts);
/// Coordinates, momenta, t, parameters; with the values that are known.
FormulaSymbols symbols_of(const ProblemNames& names);

}  // namespace hamflow::formula
