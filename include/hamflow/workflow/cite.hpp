// The works behind a method, a problem or a run, as BibTeX: what `hamflow cite` prints.
#pragma once

#include <string>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// hamflow itself and the works from which a method or a problem was taken.
/// @param name of a method, options allowed ("cg(2,6)"), or of a problem
/// @return the entries, each ended by a newline; empty if nothing has that name
std::string bibtex_of(const std::string& name);
/// hamflow itself and the works behind the method and the problem of a scenario.
std::string bibtex_of(const Scenario& scenario);

/// The keys of docs/references.bib that a declared reference names, in the order of the text.
std::vector<std::string> cited_keys(const std::string& reference);

}  // namespace hamflow
