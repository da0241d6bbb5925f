// Typed problems as entries of the catalogue, made on request.
#pragma once

#include <memory>
#include <mutex>

#include "constrained_problems.hpp"
#include "hamflow/detail/formula/model.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Whether choices are the texts of a typed problem.
bool is_typed(const std::string& name, const Choices& choices);
/// The entry of a typed problem. @throws FormulaError if a text is wrong
std::shared_ptr<const ProblemEntry> typed_problem(const std::string& name, const Choices& choices);

/// The model of an entry. For texts of the catalogue the model is derived when a function is first called, and not at
/// every start of the command; the entry needs their structure before, so it is declared with them. Copies share the
/// model.
class EntryModel {
 public:
  /// A model that exists already.
  EntryModel(std::shared_ptr<const formula::Model> made);  // NOLINT(google-explicit-constructor)
  /// @param structure the declared structure of the texts, with the usual names of momenta; made() throws if it is
  /// wrong
  EntryModel(const FormulaTexts& texts, const FormulaStructure& structure);
  std::size_t size() const { return momenta().size(); }
  std::size_t degrees() const { return size() + (structure().time ? clock_coordinates : 0); }
  const std::vector<std::string>& momenta() const { return late_->momenta; }
  const FormulaStructure& structure() const { return late_->structure; }
  const std::shared_ptr<const formula::Model>& made() const;

 private:
  struct Late {
    FormulaTexts texts{};
    std::vector<std::string> momenta{};
    FormulaStructure structure{};
    std::once_flag once{};
    std::shared_ptr<const formula::Model> model{};
  };
  std::shared_ptr<Late> late_ = std::make_shared<Late>();
};

/// A typed central force: V of r, and the chart of the states.
struct TypedField {
  std::shared_ptr<const formula::Model> radial;  // p_r^2/2 + V(r)
  bool polar = false;
};
/// The maps between typed polar states and the plane, in arithmetics with more digits.
DigitCharts polar_digit_charts();
/// The entry of a model, without info. Defined in formula_entry.cpp.
/// @param field for a central force without t: adds starts by energy and angular momentum, and orbit facts
ProblemEntry entry_of_model(const EntryModel& model, const std::optional<TypedField>& field = {});

}  // namespace hamflow
