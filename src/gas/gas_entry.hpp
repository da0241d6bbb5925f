// The gas as entries of the catalogue, one for each choice of pair law, container and cut-off: made when they are first
// asked for, kept by their choices.
#pragma once

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// The entry of choices, which lives as long as the program. What is not chosen is as in a scenario by default.
/// @throws FormulaError when a typed phi is wrong
std::shared_ptr<const ProblemEntry> gas_problem(const std::map<std::string, std::string>& choices);

/// With which container, cut-off or both the gas of these choices would take a method that it refuses: 'one only with
/// container = ...'; empty where with none.
std::string gas_that_accepts(const MethodSpec& method, const std::map<std::string, std::string>& choices);

}  // namespace hamflow
