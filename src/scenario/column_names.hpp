// Names that the user gives to columns: to observables, and to the invariants of a typed problem.
#pragma once

#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Returns the names of columns that every run has: time, step, energy, and the state, by names and by numbers.
/// @param parameters all parameters of the problem   @param size number of coordinates
std::vector<std::string> columns_of_every_run(const ProblemEntry& problem, const Texts& parameters, std::size_t size);

/// Explains why a column cannot have this name; empty if it can.
std::string refused_column(const std::string& name, const std::vector<std::string>& taken);

}  // namespace hamflow
