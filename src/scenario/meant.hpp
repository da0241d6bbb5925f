// What a beginner may have meant by a name that stands elsewhere: a potential as a problem, a key in another table.
#pragma once

#include <string>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// "; did you mean ...?" for a problem that there is not: the name of one, or one of its choices, as in
/// central-force with potential = "kepler". Empty where none is near.
std::string suggested_problem(const std::string& name);

/// What to do about a key that earlier versions had and this one has not, by its dotted path. Empty for any other key.
std::string removed_key(const std::string& path);

/// "; did you mean run.dt?" for a dotted path whose last part is a key of another table. Empty where it is none.
/// @param problem,method whose keys alone are meant; null, or empty: those of any
std::string key_elsewhere(const std::string& path, const ProblemEntry* problem = nullptr,
                          const std::string& method = "");

}  // namespace hamflow
