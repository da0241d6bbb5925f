// The names of a typed problem: expands x[n], chooses default names of momenta, and finds duplicates.
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
    std::size_t length;          // the length of a list; 0: a number
    std::vector<double> values;  // NaN if unknown
  };
  std::vector<Parameter> parameters;
  /// The parameters whose values determine sizes.
  std::set<std::string> whole;
};

/// @throws FormulaError
ProblemNames names_of(const FormulaTexts& texts);
/// Returns coordinates, momenta, t and parameters, with the known values.
FormulaSymbols symbols_of(const ProblemNames& names);

}  // namespace hamflow::formula
