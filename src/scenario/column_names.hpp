// Names that the user gives to columns: of observables and of what is watched of a typed problem.
#pragma once

#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// The columns that every run has: the time, the step, the energy, the state under its names and by number.
/// @param parameters complete   @param size of q
std::vector<std::string> columns_of_every_run(const ProblemEntry& problem, const Texts& parameters, std::size_t size);

/// Why no column can have this name, which stands in files and figures; empty where one can.
std::string refused_column(const std::string& name, const std::vector<std::string>& taken);

}  // namespace hamflow
