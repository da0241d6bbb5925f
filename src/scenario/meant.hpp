// Suggestions for names that exist in another place: a potential given as a problem, a key of another table.
#pragma once

#include <string>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// "; did you mean ...?" for an unknown problem: the nearest name of a problem, or one of its choices, as in
/// central-force with potential = "kepler". Empty if nothing is near.
std::string suggested_problem(const std::string& name);

/// Advice for a key that only earlier versions had, given by its dotted path. Empty for any other key.
std::string removed_key(const std::string& path);

/// "; did you mean run.dt?" for a dotted path whose last part is a key of another table; else empty.
/// @param problem,method only their keys are considered; null or empty: the keys of all
std::string key_elsewhere(const std::string& path, const ProblemEntry* problem = nullptr,
                          const std::string& method = "");

}  // namespace hamflow
