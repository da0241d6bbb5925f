// Suggestions for names in the wrong place: a potential given as a problem, or a key of another table.
#pragma once

#include <string>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Returns "; did you mean ...?" for an unknown problem: the nearest name of a problem, or one of its choices, as in
/// central-force with potential = "kepler". Empty if no name is near.
std::string suggested_problem(const std::string& name);

/// Returns advice for a key, given by its dotted path, that only earlier versions had. Empty for any other key.
std::string removed_key(const std::string& path);

/// Returns "; did you mean run.dt?" for a dotted path whose last part is a key of another table; otherwise empty.
/// @param problem,method consider only their keys; null or empty: the keys of all
std::string key_elsewhere(const std::string& path, const ProblemEntry* problem = nullptr,
                          const std::string& method = "");

}  // namespace hamflow
