// Problems that are typed, as entries of the catalogue: made when they are first asked for, kept by their texts.
#pragma once

#include "hamflow/formula/model.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Whether choices are the texts of a typed problem.
bool is_typed(const std::string& name, const Choices& choices);
/// Its entry, which lives as long as the program. @throws FormulaError when a text is wrong
const ProblemEntry& typed_problem(const std::string& name, const Choices& choices);

/// A field that is typed: V of r, and the chart of the states.
struct TypedField {
  std::shared_ptr<const formula::Model> radial;  // p_r^2/2 + V(r)
  bool polar = false;
};
/// The entry of a model, without info: everything that its functions give. Defined in formula_entry.cpp.
/// @param field of a central force that does not depend on t: starts by energy and angular momentum, facts of the orbit
ProblemEntry entry_of_model(std::shared_ptr<const formula::Model> model, const std::optional<TypedField>& field = {});

}  // namespace hamflow
