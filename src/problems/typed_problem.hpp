// Problems that are typed, as entries of the catalogue: made when they are asked for.
#pragma once

#include <memory>
#include <mutex>

#include "constrained_problems.hpp"
#include "hamflow/detail/formula/model.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Whether choices are the texts of a typed problem.
bool is_typed(const std::string& name, const Choices& choices);
/// Its entry. @throws FormulaError when a text is wrong
std::shared_ptr<const ProblemEntry> typed_problem(const std::string& name, const Choices& choices);

/// The model of an entry. Of texts that the catalogue itself has it is derived when a function is first called, and not
/// at every start of the command: what an entry has to know before is declared with them. Copies are one model.
class EntryModel {
 public:
  /// One that is there.
  EntryModel(std::shared_ptr<const formula::Model> made);  // NOLINT(google-explicit-constructor)
  /// @param structure what the texts are known to be, with the usual names of momenta; made() throws where they are not
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

/// A field that is typed: V of r, and the chart of the states.
struct TypedField {
  std::shared_ptr<const formula::Model> radial;  // p_r^2/2 + V(r)
  bool polar = false;
};
/// Both ways between typed polar states and the plane, in digits.
DigitCharts polar_digit_charts();
/// The entry of a model, without info: everything that its functions give. Defined in formula_entry.cpp.
/// @param field of a central force that does not depend on t: starts by energy and angular momentum, facts of the orbit
ProblemEntry entry_of_model(const EntryModel& model, const std::optional<TypedField>& field = {});

}  // namespace hamflow
