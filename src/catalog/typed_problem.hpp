// Problems that are typed, as entries of the catalogue: made when they are first asked for, kept by their texts.
#pragma once

#include "hamflow/formula/model.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Whether choices are the texts of a typed problem.
bool is_typed(const std::string& name, const Choices& choices);
/// Its entry, which lives as long as the program. @throws FormulaError when a text is wrong
const ProblemEntry& typed_problem(const std::string& name, const Choices& choices);

/// The entry of a model, without info: everything that its functions give. Defined in formula_entry.cpp.
ProblemEntry entry_of_model(std::shared_ptr<const formula::Model> model);

}  // namespace hamflow
