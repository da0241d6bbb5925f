// Which method to name in advice. Advice that its reader cannot follow is worse than none: whatever names a method as
// an alternative asks here whether it takes the problem.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Those of some methods that take a problem in an arithmetic, in their order, three at most: "stv4, cg"; empty where
/// none does.
/// @param problem null: not known, any may take it
std::string fitting_methods(std::initializer_list<std::string_view> candidates, const ProblemEntry* problem,
                            const std::string& arithmetic);
/// The same as the end of "allowed ...": "soft", or another method, e.g. stv4; empty where none fits.
/// @param what "another method"   @param before what else is allowed; decides on the "or"
std::string or_fitting_method(const std::string& before, const std::string& what,
                              std::initializer_list<std::string_view> candidates, const ProblemEntry* problem,
                              const std::string& arithmetic);

/// The same behind what is said of a method: ", e.g. stv4, cg"; empty where none fits.
std::string with_fitting_methods(std::initializer_list<std::string_view> candidates, const ProblemEntry* problem,
                                 const std::string& arithmetic);

/// What can be tried after a step that did not converge.
/// @param differentiated whether the run differentiates its steps: it then refuses to halve them
std::string hint_after_divergence(const Request& request, bool differentiated);

/// refusal() of a method in an arithmetic, and which methods take the problem in it.
std::string refusal_with_advice(const MethodSpec& spec, const ProblemEntry* problem, const std::string& arithmetic);

}  // namespace hamflow
