// Names that the user gives to columns: to observables, and to the invariants of a typed problem.
#pragma once

#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// The names of columns that every run has: time, step, energy, and the state by its names and by numbers.
/// @param parameters complete   @param size of q
std::vector<std::string> columns_of_every_run(const ProblemEntry& problem, const Texts& parameters, std::size_t size);

/// Why a column cannot have this name; empty if it can.
std::string refused_column(const std::string& name, const std::vector<std::string>& taken);

}  // namespace hamflow
