// Returns the works on which a method, a problem or a run is based, as BibTeX, for `hamflow cite`.
#pragma once

#include <string>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// Returns hamflow itself and the works from which a method or a problem was taken.
/// @param name name of a method, possibly with options ("cg(2,6)"), or of a problem
/// @return the entries, each ended by a newline; empty if nothing has that name
std::string bibtex_of(const std::string& name);
/// Returns hamflow itself and the works for the method and the problem of a scenario.
std::string bibtex_of(const Scenario& scenario);

/// Returns the keys of docs/references.bib that a declared reference names, in the order of the text.
std::vector<std::string> cited_keys(const std::string& reference);

}  // namespace hamflow
