// What the catalogue declares, as text: what `hamflow list` and `hamflow show` print.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// The methods to begin with and the names of all others, or each with a line.
std::string methods_text(bool all);
std::string problems_text();
std::string methods_json();
std::string problems_json();

struct CatalogueText {
  std::string text;
  std::vector<std::string> formulas{};  // of a problem: H of each of its variants, as LaTeX
};

/// A problem, a method ("cg" or "cg(1,5)"), a kind of figure, or the keys of a table of scenarios; none where nothing
/// has that name.   @throws Error when the options of the method are wrong
std::optional<CatalogueText> catalogue_text(const std::string& name);
/// What a scenario describes: its problem, its structure and its start.
CatalogueText description_of(const Scenario& scenario);
/// Says that nothing has a name, and proposes the nearest one.
/// @param experiments of the theses, where the caller knows them
std::string not_in_catalogue(const std::string& name, const std::vector<std::string>* experiments = nullptr);

}  // namespace hamflow
