// The gas as entries of the catalogue, one for each choice of pair law, container and cut-off. An entry is made at the
// first request and then kept.
#pragma once

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// The entry of the choices, which exists as long as the program. Missing choices take the defaults of a scenario.
/// @throws FormulaError if a typed phi is wrong
std::shared_ptr<const ProblemEntry> gas_problem(const std::map<std::string, std::string>& choices);

/// For a refused method: the container or cut-off with which the gas would accept it, 'only with container = ...';
/// empty if there is none.
std::string gas_that_accepts(const MethodSpec& method, const std::map<std::string, std::string>& choices);

}  // namespace hamflow
