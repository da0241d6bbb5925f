// The declarations of the catalogue as text, as `hamflow list` and `hamflow show` print them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// Returns a line for each recommended method and the names of all others; with `all`, a line for every method.
std::string methods_text(bool all);
std::string problems_text();
std::string methods_json();
std::string problems_json();

struct CatalogueText {
  std::string text;
  std::vector<std::string> formulas{};  // for a problem: H of each of its variants as LaTeX
};

/// Describes a problem, a method ("cg" or "cg(1,5)"), a kind of figure, or the keys of a table of scenarios. Returns
/// nullopt if nothing has this name.   @throws Error if the options of the method are wrong
std::optional<CatalogueText> catalogue_text(const std::string& name);
/// Describes a scenario: its problem, the structure of H and the start.
CatalogueText description_of(const Scenario& scenario);
/// Returns the message that a name is unknown, with the nearest known name.
/// @param experiments names of the experiments of the theses, if the caller knows them
std::string not_in_catalogue(const std::string& name, const std::vector<std::string>* experiments = nullptr);

}  // namespace hamflow
